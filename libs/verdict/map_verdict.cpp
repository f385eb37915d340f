// SPDX-License-Identifier: BSD-3-Clause
#include "verdict/map_verdict.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "pose_graph/path_covariance.h"
#include "verdict/loop_residuals.h"
#include "verdict/path_suspects.h"

namespace psi_slam {
namespace {

using mrpt::math::TPoint2D;

/// A map with everything that was measured on it.
class Judge {
 public:
  Judge(const MappingResult& result, const VerdictOptions& options)
      : result_(result),
        options_(options),
        views_(map_views(result, options.views)),
        checks_(check_passes(views_, options.passes)),
        errors_(errors_of_views(views_.size(), checks_)),
        residuals_(loop_residuals(result)),
        path_suspects_(path_suspects(result)) {
    sum_blame();
    for (const PathSuspect& suspect : path_suspects_)
      if (suspect.kind == PathSuspect::Kind::kLost && is_contradicted(suspect))
        contradicted_.push_back(&suspect);
  }

  MapVerdict verdict() const {
    MapVerdict verdict;
    add_wall_spots(verdict.hot_spots);
    add_misfits(verdict.hot_spots);
    add_conflicts(verdict.hot_spots);
    add_path_spots(verdict.hot_spots);
    std::stable_sort(verdict.hot_spots.begin(), verdict.hot_spots.end(),
                     [](const HotSpot& a, const HotSpot& b) { return weight(a) > weight(b); });
    if (verdict.hot_spots.size() > options_.most_hot_spots) verdict.hot_spots.resize(options_.most_hot_spots);
    measure_walls(verdict);
    verdict.error_m = mean_error_m() + unconfirmed_error_m(verdict.hot_spots);
    verdict.predicted_m = mean_prediction_m();
    const bool is_broken =
        (verdict.error_m >= options_.broken_error_m && !verdict.hot_spots.empty()) ||
        std::any_of(verdict.hot_spots.begin(), verdict.hot_spots.end(),
                    [](const HotSpot& spot) { return spot.kind == HotSpot::Kind::kUnplacedRun; });
    verdict.state = is_broken                   ? MapState::kBroken
                    : verdict.hot_spots.empty() ? MapState::kGood
                                                : MapState::kCheck;
    return verdict;
  }

 private:
  static double weight(const HotSpot& spot) {
    return spot.kind == HotSpot::Kind::kUnplacedRun ? std::numeric_limits<double>::infinity()
                                                    : spot.error_m * (1 + spot.length_m);
  }

  TPoint2D place_of(std::size_t frame) const {
    const mrpt::math::TPose2D& pose = result_.frames[frame].map_T_robot;
    return {pose.x, pose.y};
  }

  Suspect stretch(Suspect::Kind kind, std::size_t first_frame, std::size_t last_frame) const {
    return {kind, 0, 0, first_frame, last_frame, place_of((first_frame + last_frame) / 2)};
  }

  Suspect suspect_of(const LoopResidual& residual) const {
    const LoopRecord& loop = result_.loops[residual.loop];
    return {Suspect::Kind::kLoop, residual.loop,       loop.local_map, result_.node_frames[loop.anchor],
            loop.frame,           place_of(loop.frame)};
  }

  Suspect suspect_of(const PathSuspect& suspect) const {
    using Kind = PathSuspect::Kind;
    const Suspect::Kind kind = suspect.kind == Kind::kUnmatched ? Suspect::Kind::kUnmatched
                               : suspect.kind == Kind::kLost    ? Suspect::Kind::kLost
                                                                : Suspect::Kind::kUnplaced;
    Suspect cause = stretch(kind, suspect.first_frame, suspect.last_frame);
    if (kind != Suspect::Kind::kUnmatched) cause.at = place_of(suspect.first_frame);
    return cause;
  }

  /// Blames each step between successive views for the displacements of all pairs of views across it. Pairs
  /// that fit clear the steps between them.
  void sum_blame() {
    std::vector<double> change(views_.size() + 1, 0);
    for (const PassCheck& check : checks_) {
      const auto [first, last] = std::minmax(check.view, check.other);
      const double blame = std::clamp(check.error_m - options_.spot_error_m / 2, -options_.spot_error_m,
                                      options_.passes.unknown_m);
      change[first] += blame;
      change[last] -= blame;
    }
    double sum = 0;
    for (std::size_t step = 0; step < views_.size(); ++step) blame_.push_back(sum += change[step]);
  }

  bool is_conflict(const LoopResidual& residual) const {
    return residual.chi >= options_.conflict_chi && residual.residual_m >= options_.conflict_m;
  }

  /// Whether a check compares views on both sides of the first frame of a stretch.
  bool spans(const PassCheck& check, const PathSuspect& suspect) const {
    const auto [first, last] = std::minmax(views_[check.view].frame, views_[check.other].frame);
    return first < suspect.first_frame && last >= suspect.first_frame;
  }

  /// Whether the scans after an interruption see through the walls of those before it. The share counts over
  /// all their checks: a robot that was placed into a similar corridor fits well at most places.
  bool is_contradicted(const PathSuspect& suspect) const {
    std::size_t same = 0;
    std::size_t seen_through = 0;
    for (const PassCheck& check : checks_) {
      if (check.same_pass || !spans(check, suspect)) continue;
      same += check.scans.same;
      seen_through += check.scans.seen_through;
    }
    return static_cast<double>(seen_through) >
           options_.contradiction * static_cast<double>(same + seen_through);
  }

  /// The most likely cause of a displacement between two views.
  Suspect cause_between(std::size_t view, std::size_t other) const {
    if (!residuals_.empty() && is_conflict(residuals_.front())) return suspect_of(residuals_.front());
    const auto [first, last] = std::minmax(view, other);
    const std::size_t first_frame = views_[first].frame;
    const std::size_t last_frame = views_[last].frame;
    for (const PathSuspect* lost : contradicted_)
      if (lost->first_frame > first_frame && lost->first_frame <= last_frame) return suspect_of(*lost);
    const PathSuspect* worst = nullptr;
    for (const PathSuspect& suspect : path_suspects_)
      if (suspect.kind == PathSuspect::Kind::kUnmatched && suspect.last_frame > first_frame &&
          suspect.first_frame <= last_frame && (worst == nullptr || suspect.doubt_m > worst->doubt_m))
        worst = &suspect;
    if (worst != nullptr) return suspect_of(*worst);
    const auto at = [&](std::size_t step) { return blame_.begin() + static_cast<std::ptrdiff_t>(step); };
    const auto begin = std::max_element(at(first), at(last));
    auto end = begin;
    while (end != at(last) && *end == *begin) ++end;
    return stretch(Suspect::Kind::kStretch, views_[static_cast<std::size_t>(begin - blame_.begin())].frame,
                   views_[static_cast<std::size_t>(end - blame_.begin())].frame);
  }

  HotSpot spot_of(const PassCheck& check, HotSpot::Kind kind) const {
    return {kind, check.scans.at, check.error_m, 0, cause_between(check.view, check.other)};
  }

  HotSpot::Kind kind_of(const PassCheck& check) const {
    if (views_[check.view].run != views_[check.other].run) return HotSpot::Kind::kRunsDisagree;
    return check.scans.seen_through_share() > 0.5 ? HotSpot::Kind::kSeenThroughWall
                                                  : HotSpot::Kind::kDoubledWall;
  }

  /// Makes one hot spot of each series of displaced views.
  void add_wall_spots(std::vector<HotSpot>& spots) const {
    constexpr std::size_t kLargestGap = 3;  // views between the displaced views of one hot spot
    const PassCheck* worst = nullptr;
    std::size_t first = 0;
    std::size_t last = 0;
    std::size_t count = 0;
    const auto close = [&] {
      const PassCheck* check = std::exchange(worst, nullptr);
      if (check == nullptr) return;
      const double length_m = std::abs(views_[last].travelled_m - views_[first].travelled_m);
      // Doors and furniture move, too; misplaced walls are longer.
      if (length_m < options_.least_length_m || count < options_.least_checks) return;
      spots.push_back(spot_of(*check, kind_of(*check)));
      spots.back().length_m = length_m;
    };
    for (const PassCheck& check : checks_) {
      if (check.same_pass || check.error_m < options_.spot_error_m) continue;
      if (worst != nullptr && (check.view > last + kLargestGap || views_[check.view].run != views_[last].run))
        close();
      if (worst == nullptr) {
        first = check.view;
        count = 0;
      }
      ++count;
      if (worst == nullptr || check.error_m > worst->error_m) worst = &check;
      last = check.view;
    }
    close();
  }

  /// Makes one hot spot of each series of at least two scans that do not fit the scans before them.
  void add_misfits(std::vector<HotSpot>& spots) const {
    const PassCheck* before = nullptr;
    bool is_series = false;
    for (const PassCheck& check : checks_) {
      if (!check.same_pass) continue;
      if (check.error_m < options_.misfit_m) {
        before = nullptr;
        is_series = false;
        continue;
      }
      if (before != nullptr && !is_series) {
        spots.push_back(spot_of(*before, HotSpot::Kind::kMisfit));
        is_series = true;
      }
      if (is_series) {
        spots.back().length_m += options_.views.step_m;
        spots.back().error_m = std::max(spots.back().error_m, check.error_m);
      }
      before = &check;
    }
  }

  void add_conflicts(std::vector<HotSpot>& spots) const {
    if (residuals_.empty() || !is_conflict(residuals_.front())) return;
    const LoopResidual& worst = residuals_.front();  // true loops nearby have residuals because of it
    const Suspect suspect = suspect_of(worst);
    spots.push_back({HotSpot::Kind::kLoopConflict, suspect.at,
                     std::min(worst.residual_m, options_.passes.unknown_m), 0, suspect});
  }

  /// Whether a pass that fits holds both ends of a stretch together.
  bool is_confirmed(const PathSuspect& suspect) const {
    return std::any_of(checks_.begin(), checks_.end(), [&](const PassCheck& check) {
      const auto [first, last] = std::minmax(views_[check.view].frame, views_[check.other].frame);
      return check.error_m < options_.spot_error_m && first < suspect.first_frame &&
             last > suspect.last_frame;
    });
  }

  void add_path_spots(std::vector<HotSpot>& spots) const {
    for (const PathSuspect& suspect : path_suspects_) {
      const Suspect cause = suspect_of(suspect);
      if (suspect.kind == PathSuspect::Kind::kUnplaced)
        spots.push_back({HotSpot::Kind::kUnplacedRun, cause.at, options_.passes.unknown_m, 0, cause});
      if (std::count(contradicted_.begin(), contradicted_.end(), &suspect) > 0)
        spots.push_back({HotSpot::Kind::kRunsDisagree, cause.at, options_.passes.unknown_m, 0, cause});
      if (suspect.kind == PathSuspect::Kind::kUnmatched && suspect.doubt_m >= options_.unconfirmed_m &&
          !is_confirmed(suspect))
        spots.push_back(
            {HotSpot::Kind::kUnmatched, cause.at, options_.unmatched_error * suspect.doubt_m, 0, cause});
    }
  }

  /// Mean error over the views that other passes or successive scans check.
  double mean_error_m() const {
    std::vector<std::optional<double>> errors = errors_;
    for (const PassCheck& check : checks_)
      if (check.same_pass && check.error_m >= options_.misfit_m)
        errors[check.view] = std::max(errors[check.view].value_or(0), check.error_m);
    double sum_m = 0;
    std::size_t checked = 0;
    for (const std::optional<double>& error_m : errors) {
      sum_m += error_m.value_or(0);
      checked += error_m ? 1 : 0;
    }
    return checked == 0 ? 0 : sum_m / static_cast<double>(checked);
  }

  /// Mean error if the two parts of the map before and after `frame` are displaced by `apart_m`.
  double error_of_parts_m(std::size_t frame, double apart_m) const {
    const double share = static_cast<double>(frame) / static_cast<double>(result_.frames.size());
    return 2 * share * (1 - share) * apart_m;
  }

  /// Largest mean error by stretches and runs that no pass confirms.
  double unconfirmed_error_m(const std::vector<HotSpot>& spots) const {
    double worst_m = 0;
    for (const HotSpot& spot : spots) {
      const bool is_lost =
          spot.kind == HotSpot::Kind::kUnplacedRun ||
          (spot.kind == HotSpot::Kind::kRunsDisagree && spot.suspect.kind == Suspect::Kind::kLost);
      if (is_lost)
        worst_m = std::max(worst_m, error_of_parts_m(spot.suspect.first_frame, options_.passes.unknown_m));
      if (spot.kind == HotSpot::Kind::kUnmatched) worst_m = std::max(worst_m, spot.error_m);
    }
    return worst_m;
  }

  double mean_prediction_m() const {
    if (views_.empty()) return 0;
    PathCovarianceSearch search;
    search.run(result_.graph, result_.graph.root());
    double sum_m = 0;
    for (const MapView& view : views_) {
      const RelativeUncertainty uncertainty = search.of(view.node);
      if (uncertainty.reached) sum_m += uncertainty.position_sigma_m();
    }
    return sum_m / static_cast<double>(views_.size());
  }

  void measure_walls(MapVerdict& verdict) const {
    const auto checked = static_cast<double>(std::count_if(
        errors_.begin(), errors_.end(), [](const auto& error_m) { return error_m.has_value(); }));
    if (!views_.empty()) verdict.checked_share = checked / static_cast<double>(views_.size());
    std::vector<double> offsets_m;
    for (const PassCheck& check : checks_)
      if (!check.same_pass) offsets_m.push_back(check.scans.offset_m);
    if (offsets_m.empty()) return;
    const auto rank = offsets_m.begin() + static_cast<std::ptrdiff_t>(offsets_m.size() * 9 / 10);
    std::nth_element(offsets_m.begin(), rank, offsets_m.end());
    verdict.wall_thickness_m = *rank;
  }

  const MappingResult& result_;
  const VerdictOptions& options_;
  std::vector<MapView> views_;
  std::vector<PassCheck> checks_;
  std::vector<std::optional<double>> errors_;  // of each view
  std::vector<LoopResidual> residuals_;
  std::vector<PathSuspect> path_suspects_;
  std::vector<const PathSuspect*> contradicted_;  // interruptions after which the robot was misplaced
  std::vector<double> blame_;                     // of the step after each view
};

}  // namespace

MapVerdict judge_map(const MappingResult& result, const VerdictOptions& options) {
  return Judge(result, options).verdict();
}

}  // namespace psi_slam
