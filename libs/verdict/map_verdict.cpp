// SPDX-License-Identifier: BSD-3-Clause
#include "verdict/map_verdict.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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
    const bool is_broken =
        verdict.error_m >= options_.broken_error_m ||
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
    return stretch(kind, suspect.first_frame, suspect.last_frame);
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

  /// The most likely cause of a displacement between two views.
  Suspect cause_between(std::size_t view, std::size_t other) const {
    if (!residuals_.empty() && is_conflict(residuals_.front())) return suspect_of(residuals_.front());
    const auto [first, last] = std::minmax(view, other);
    const PathSuspect* worst = nullptr;
    for (const PathSuspect& suspect : path_suspects_)
      if (suspect.last_frame > views_[first].frame && suspect.first_frame <= views_[last].frame &&
          (worst == nullptr || suspect.doubt_m > worst->doubt_m))
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
    const auto close = [&] {
      if (worst == nullptr) return;
      spots.push_back(spot_of(*worst, kind_of(*worst)));
      spots.back().length_m = std::abs(views_[last].travelled_m - views_[first].travelled_m);
      worst = nullptr;
    };
    for (const PassCheck& check : checks_) {
      if (check.same_pass || check.error_m < options_.spot_error_m) continue;
      if (worst != nullptr && (check.view > last + kLargestGap || views_[check.view].run != views_[last].run))
        close();
      if (worst == nullptr) first = check.view;
      if (worst == nullptr || check.error_m > worst->error_m) worst = &check;
      last = check.view;
    }
    close();
  }

  void add_misfits(std::vector<HotSpot>& spots) const {
    std::size_t clear = 0;  // first view that no hot spot covers
    for (const PassCheck& check : checks_) {
      if (!check.same_pass || check.error_m < options_.misfit_m || check.other < clear) continue;
      spots.push_back(spot_of(check, HotSpot::Kind::kMisfit));
      clear = check.view + 1;
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
      if (suspect.kind == PathSuspect::Kind::kUnmatched && suspect.doubt_m >= options_.unconfirmed_m &&
          !is_confirmed(suspect))
        spots.push_back({HotSpot::Kind::kUnmatched, cause.at, 0.1 * suspect.doubt_m, 0, cause});
    }
  }

  void measure_walls(MapVerdict& verdict) const {
    double sum_m = 0;
    std::size_t checked = 0;
    for (const std::optional<double>& error_m : errors_) {
      if (!error_m) continue;
      sum_m += *error_m;
      ++checked;
    }
    if (checked > 0) verdict.error_m = sum_m / static_cast<double>(checked);
    if (!views_.empty())
      verdict.checked_share = static_cast<double>(checked) / static_cast<double>(views_.size());
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
  std::vector<double> blame_;  // of the step after each view
};

}  // namespace

MapVerdict judge_map(const MappingResult& result, const VerdictOptions& options) {
  return Judge(result, options).verdict();
}

}  // namespace psi_slam
