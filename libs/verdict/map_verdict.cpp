// SPDX-License-Identifier: BSD-3-Clause
#include "verdict/map_verdict.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

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
        path_suspects_(path_suspects(result)),
        searched_loops_(std::any_of(result.frames.begin(), result.frames.end(),
                                    [](const FrameRecord& frame) { return frame.searched_loops; })) {
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
    if (verdict.hot_spots.size() > options_.most_hot_spots) {
      verdict.more_hot_spots = verdict.hot_spots.size() - options_.most_hot_spots;
      verdict.hot_spots.resize(options_.most_hot_spots);
    }
    return verdict;
  }

 private:
  static double weight(const HotSpot& spot) {
    return spot.error_m.value_or(std::numeric_limits<double>::infinity()) * (1 + spot.length_m);
  }

  TPoint2D place_of(std::size_t frame) const {
    const mrpt::math::TPose2D& pose = result_.frames[frame].map_T_robot;
    return {pose.x, pose.y};
  }

  Suspect stretch(Suspect::Kind kind, std::size_t first_frame, std::size_t last_frame) const {
    return {kind, 0, 0, first_frame, last_frame, place_of((first_frame + last_frame) / 2), searched_loops_};
  }

  Suspect suspect_of(const LoopResidual& residual) const {
    const LoopRecord& loop = result_.loops[residual.loop];
    return {Suspect::Kind::kLoop, residual.loop, loop.local_map, result_.node_frames[loop.anchor], loop.frame,
            place_of(loop.frame), true};
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

  /// Whether the path that a loop bends, from its anchor to its node, overlaps the path between two frames.
  bool bends_between(const LoopResidual& residual, std::size_t first_frame, std::size_t last_frame) const {
    const LoopRecord& loop = result_.loops[residual.loop];
    const auto [first, last] = std::minmax(result_.node_frames[loop.anchor], loop.frame);
    return first < last_frame && last > first_frame;
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
    const auto [first, last] = std::minmax(view, other);
    const std::size_t first_frame = views_[first].frame;
    const std::size_t last_frame = views_[last].frame;
    const auto loop = std::find_if(residuals_.begin(), residuals_.end(), [&](const LoopResidual& residual) {
      return is_conflict(residual) && bends_between(residual, first_frame, last_frame);
    });
    if (loop != residuals_.end()) return suspect_of(*loop);
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

  HotSpot::Kind kind_of(const PassCheck& check) const {
    if (views_[check.view].run != views_[check.other].run) return HotSpot::Kind::kRunsDisagree;
    return check.scans.seen_through_share() > 0.5 ? HotSpot::Kind::kSeenThroughWall
                                                  : HotSpot::Kind::kDoubledWall;
  }

  /// Displaced views of one run that follow each other.
  struct Series {
    const PassCheck* worst = nullptr;
    std::size_t first = 0;  // view
    std::size_t last = 0;   // view
    std::size_t count = 0;  // displaced comparisons
  };

  /// Series of the comparisons within a pass, or between passes, with errors from least_error_m on.
  /// Successive views of a series are at most `largest_step` views apart.
  std::vector<Series> series_of(bool same_pass, double least_error_m, std::size_t largest_step) const {
    std::vector<Series> all;
    for (const PassCheck& check : checks_) {
      if (check.same_pass != same_pass || check.error_m < least_error_m) continue;
      if (all.empty() || check.view > all.back().last + largest_step ||
          views_[check.view].run != views_[all.back().last].run)
        all.push_back({&check, check.view, check.view, 0});
      Series& series = all.back();
      if (check.error_m > series.worst->error_m) series.worst = &check;
      series.last = check.view;
      ++series.count;
    }
    return all;
  }

  double length_m(const Series& series) const {
    return std::abs(views_[series.last].travelled_m - views_[series.first].travelled_m);
  }

  HotSpot spot_of(const Series& series, HotSpot::Kind kind) const {
    const PassCheck& worst = *series.worst;
    return {kind, worst.scans.at, worst.error_m, length_m(series), cause_between(worst.view, worst.other)};
  }

  /// Makes one hot spot of each series of displaced views.
  void add_wall_spots(std::vector<HotSpot>& spots) const {
    constexpr std::size_t kLargestStep = 3;  // views between the displaced views of one hot spot
    for (const Series& series : series_of(false, options_.spot_error_m, kLargestStep))
      // Doors and furniture move, too; misplaced walls are longer.
      if (length_m(series) >= options_.least_length_m && series.count >= options_.least_checks)
        spots.push_back(spot_of(series, kind_of(*series.worst)));
  }

  /// Makes one hot spot of each series of at least two scans that do not fit the scans before them.
  void add_misfits(std::vector<HotSpot>& spots) const {
    for (const Series& series : series_of(true, options_.misfit_m, 1))
      if (series.count >= 2) spots.push_back(spot_of(series, HotSpot::Kind::kMisfit));
  }

  void add_conflicts(std::vector<HotSpot>& spots) const {
    // True loops nearby have residuals because of the worst one.
    const auto worst = std::find_if(residuals_.begin(), residuals_.end(),
                                    [&](const LoopResidual& residual) { return is_conflict(residual); });
    if (worst == residuals_.end()) return;
    const Suspect suspect = suspect_of(*worst);
    spots.push_back({HotSpot::Kind::kLoopConflict, suspect.at,
                     std::min(worst->residual_m, options_.passes.unknown_m), 0, suspect});
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
        spots.push_back({HotSpot::Kind::kUnplacedRun, cause.at, std::nullopt, 0, cause});
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
      if (check.same_pass)
        errors[check.view] = std::max(errors[check.view].value_or(0),
                                      check.error_m >= options_.misfit_m ? check.error_m : 0.0);
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
      if (spot.kind == HotSpot::Kind::kUnmatched)
        worst_m = std::max(worst_m, error_of_parts_m(spot.suspect.first_frame, *spot.error_m));
    }
    return worst_m;
  }

  bool is_unplaced(const MapView& view, const std::vector<FrameSpan>& runs) const {
    return std::any_of(path_suspects_.begin(), path_suspects_.end(), [&](const PathSuspect& suspect) {
      return suspect.kind == PathSuspect::Kind::kUnplaced && suspect.first_frame == runs[view.run].begin;
    });
  }

  double mean_prediction_m() const {
    if (views_.empty()) return 0;
    const std::vector<FrameSpan> runs = runs_of(result_);
    PathCovarianceSearch search;
    search.run(result_.graph, 0);
    double sum_m = 0;
    std::size_t count = 0;
    for (const MapView& view : views_) {
      const RelativeUncertainty uncertainty = search.of(view.node);
      if (!uncertainty.reached || is_unplaced(view, runs)) continue;
      sum_m += uncertainty.position_sigma_m();
      ++count;
    }
    return count == 0 ? 0 : sum_m / static_cast<double>(count);
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
  bool searched_loops_ = false;                   // by any scan
  std::vector<const PathSuspect*> contradicted_;  // interruptions after which the robot was misplaced
  std::vector<double> blame_;                     // of the step after each view
};

}  // namespace

MapVerdict judge_map(const MappingResult& result, const VerdictOptions& options) {
  return Judge(result, options).verdict();
}

}  // namespace psi_slam
