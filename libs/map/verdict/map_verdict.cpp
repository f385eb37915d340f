// SPDX-License-Identifier: BSD-3-Clause
#include "map/verdict/map_verdict.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "map/verdict/edit_advice.h"
#include "map/verdict/interruption_checks.h"
#include "map/verdict/loop_residuals.h"
#include "map/verdict/path_suspects.h"
#include "map/verdict/uncertain_stretches.h"
#include "mapping/scan_place.h"
#include "pose_graph/aligned_uncertainty.h"

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
    find_fitting_reach();
    std::vector<std::size_t> nodes;
    for (const MapView& view : views_) nodes.push_back(view.node);
    sigmas_m_ = aligned_sigmas_m(result.graph, nodes);
    for (const InterruptionCheck& check :
         check_interruptions(result, views_, checks_, path_suspects_, explained_stretches(), options.passes))
      if (check.contradicted > options.contradiction) contradicted_.push_back(check);
  }

  MapVerdict verdict() const {
    MapVerdict verdict;
    add_wall_spots(verdict.hot_spots);
    add_misfits(verdict.hot_spots);
    add_conflicts(verdict.hot_spots);
    add_path_spots(verdict.hot_spots);
    add_interruptions(verdict.hot_spots);
    add_uncertain_places(verdict.hot_spots);
    measure_walls(verdict);
    add_open_stretches(verdict);
    if (verdict.hot_spots.empty()) add_thickest_wall(verdict);
    std::stable_sort(verdict.hot_spots.begin(), verdict.hot_spots.end(), is_worse);
    for (HotSpot& spot : verdict.hot_spots)
      spot.places_of_suspect = static_cast<std::size_t>(
          std::count_if(verdict.hot_spots.begin(), verdict.hot_spots.end(),
                        [&](const HotSpot& other) { return is_same(spot.suspect, other.suspect); }));
    add_confirmed_stretches(verdict);
    verdict.unchecked_stretches = unchecked_stretches(views_, errors_, sigmas_m_, options_.least_length_m);
    verdict.error_m = mean_error_m() + unconfirmed_error_m(verdict.hot_spots);
    verdict.predicted_m = mean_prediction_m();
    const bool is_broken =
        (verdict.error_m >= options_.broken_error_m && !verdict.hot_spots.empty()) ||
        std::any_of(verdict.hot_spots.begin(), verdict.hot_spots.end(),
                    [](const HotSpot& spot) { return spot.kind == HotSpot::Kind::kUnplacedRun; });
    verdict.state = is_broken                    ? MapState::kBroken
                    : !verdict.hot_spots.empty() ? MapState::kCheck
                    : verdict.held_share > 0.5   ? MapState::kGood
                                                 : MapState::kUnchecked;
    if (!is_broken) verdict.changes = scene_changes(result_, views_, checks_, options_.least_checks);
    for (const HotSpot& spot : verdict.hot_spots)
      verdict.largest_error_m = std::max(verdict.largest_error_m, spot.error_m.value_or(0));
    if (verdict.hot_spots.size() > options_.most_hot_spots) {
      verdict.more_hot_spots = verdict.hot_spots.size() - options_.most_hot_spots;
      verdict.hot_spots.resize(options_.most_hot_spots);
    }
    add_edits(verdict.hot_spots);
    return verdict;
  }

 private:
  /// Whether hot spot a comes before b: what scans show before what is predicted, then by the error, then by
  /// the length of the path.
  static bool is_worse(const HotSpot& a, const HotSpot& b) {
    const auto rank = [](const HotSpot& spot) {
      return std::make_tuple(!is_predicted(spot.kind),
                             spot.error_m.value_or(std::numeric_limits<double>::infinity()), spot.length_m);
    };
    return rank(a) > rank(b);
  }

  void add_edits(std::vector<HotSpot>& spots) const {
    if (spots.empty()) return;
    EditAdvice advice(result_, views_, checks_, options_);
    for (HotSpot& spot : spots) advice.add_to(spot);
  }

  TPoint2D place_of(std::size_t frame) const {
    const mrpt::math::TPose2D& pose = result_.frames[frame].map_T_robot;
    return {pose.x, pose.y};
  }

  Suspect stretch(Suspect::Kind kind, std::size_t first_frame, std::size_t last_frame) const {
    Suspect suspect;
    suspect.kind = kind;
    suspect.first_frame = first_frame;
    suspect.last_frame = last_frame;
    suspect.at = place_of((first_frame + last_frame) / 2);
    suspect.searched_loops = searched_loops_;
    const auto& later = result_.later_run_frames;
    suspect.last_s = time_in_run_s(result_.frames, later, last_frame);
    if (std::upper_bound(later.begin(), later.end(), first_frame) ==
        std::upper_bound(later.begin(), later.end(), last_frame))
      suspect.first_s = time_in_run_s(result_.frames, later, first_frame);
    return suspect;
  }

  Suspect suspect_of(const LoopResidual& residual) const {
    const LoopRecord& loop = result_.loops[residual.loop];
    Suspect suspect = stretch(Suspect::Kind::kLoop, result_.node_frames[loop.reference], loop.frame);
    suspect.loop = residual.loop;
    suspect.local_map = loop.local_map;
    suspect.at = place_of(loop.frame);
    suspect.searched_loops = true;
    return suspect;
  }

  Suspect suspect_of(const PathSuspect& suspect) const {
    const bool is_unmatched = suspect.kind == PathSuspect::Kind::kUnmatched;
    Suspect cause = stretch(kind_of(suspect.kind), suspect.first_frame, suspect.last_frame);
    if (!is_unmatched) cause.at = place_of(suspect.first_frame);
    return cause;
  }

  static Suspect::Kind kind_of(PathSuspect::Kind kind) {
    switch (kind) {
      case PathSuspect::Kind::kUnmatched:
        return Suspect::Kind::kUnmatched;
      case PathSuspect::Kind::kLost:
        return Suspect::Kind::kLost;
      case PathSuspect::Kind::kUnplaced:
        return Suspect::Kind::kUnplaced;
      case PathSuspect::Kind::kGap:
        break;
    }
    return Suspect::Kind::kGap;
  }

  /// Blames each step between successive views for the displacements of all pairs of views across it. Pairs
  /// that fit clear the steps between them.
  void sum_blame() {
    std::vector<double> change(views_.size() + 1, 0);
    for (const PassCheck& check : checks_) {
      if (check.scene_changed) continue;
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

  /// Whether the path that a loop bends, from its reference to its node, overlaps the path between two
  /// frames.
  bool bends_between(const LoopResidual& residual, std::size_t first_frame, std::size_t last_frame) const {
    const LoopRecord& loop = result_.loops[residual.loop];
    const auto [first, last] = std::minmax(result_.node_frames[loop.reference], loop.frame);
    return first < last_frame && last > first_frame;
  }

  /// Stretches that explain a displacement of the passes across them: loops in conflict bend the path from
  /// reference to node, and long unmatched motion has errors.
  std::vector<FrameSpan> explained_stretches() const {
    std::vector<FrameSpan> stretches;
    for (const LoopResidual& residual : residuals_) {
      if (!is_conflict(residual)) continue;
      const LoopRecord& loop = result_.loops[residual.loop];
      const auto [first, last] = std::minmax(result_.node_frames[loop.reference], loop.frame);
      stretches.push_back({first, last});
    }
    for (const PathSuspect& suspect : path_suspects_)
      if (suspect.kind == PathSuspect::Kind::kUnmatched && suspect.doubt_m >= options_.unconfirmed_m)
        stretches.push_back({suspect.first_frame - 1, suspect.last_frame});
    return stretches;
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
    for (const InterruptionCheck& check : contradicted_)
      if (check.suspect.first_frame > first_frame && check.suspect.first_frame <= last_frame)
        return suspect_of(check.suspect);
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
    return step_suspect(views_[static_cast<std::size_t>(begin - blame_.begin())].frame,
                        views_[static_cast<std::size_t>(end - blame_.begin())].frame);
  }

  /// The step of the path between two frames: the interruption or gap in it, or else the stretch.
  Suspect step_suspect(std::size_t first_frame, std::size_t last_frame) const {
    const auto lost = std::find_if(path_suspects_.begin(), path_suspects_.end(), [&](const PathSuspect& one) {
      return one.kind != PathSuspect::Kind::kUnmatched && one.first_frame > first_frame &&
             one.first_frame <= last_frame;
    });
    return lost != path_suspects_.end() ? suspect_of(*lost)
                                        : stretch(Suspect::Kind::kStretch, first_frame, last_frame);
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
      // Successive scans are close. If no small motion makes them fit, the scene changed, not the pose.
      if (same_pass && !check.fits_if_moved) continue;
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
    HotSpot spot{kind, worst.scans.at, worst.error_m, length_m(series),
                 cause_between(worst.view, worst.other)};
    spot.seen_by = {views_[series.first].frame, views_[series.last].frame + 1};
    return spot;
  }

  /// Makes one hot spot of each series of displaced views.
  void add_wall_spots(std::vector<HotSpot>& spots) const {
    for (const Series& series : series_of(false, options_.spot_error_m, kLargestStep))
      // Doors and furniture move, too; misplaced walls are longer.
      if (length_m(series) >= options_.least_length_m && series.count >= options_.least_checks)
        spots.push_back(spot_of(series, kind_of(*series.worst)));
  }

  /// Makes one hot spot of each series of at least two scans that are displaced from the scans before them.
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

  /// Finds up to where checks that fit reach, for is_confirmed().
  void find_fitting_reach() {
    for (const PassCheck& check : checks_) {
      if (check.scene_changed || check.error_m >= options_.spot_error_m) continue;
      const auto [first, last] = std::minmax(views_[check.view].frame, views_[check.other].frame);
      fitting_reach_.emplace_back(first, last);
    }
    std::sort(fitting_reach_.begin(), fitting_reach_.end());
    for (std::size_t i = 1; i < fitting_reach_.size(); ++i)
      fitting_reach_[i].second = std::max(fitting_reach_[i].second, fitting_reach_[i - 1].second);
  }

  /// Whether a pass that fits holds both ends of a stretch together.
  bool is_confirmed(const PathSuspect& suspect) const {
    const auto after = std::lower_bound(fitting_reach_.begin(), fitting_reach_.end(),
                                        std::pair<std::size_t, std::size_t>(suspect.first_frame, 0));
    return after != fitting_reach_.begin() && std::prev(after)->second > suspect.last_frame;
  }

  /// Adds the unmatched stretches that checks confirm and that are the suspect of no hot spot.
  void add_confirmed_stretches(MapVerdict& verdict) const {
    for (const PathSuspect& stretch : path_suspects(result_, 0)) {
      if (stretch.kind != PathSuspect::Kind::kUnmatched || !is_confirmed(stretch)) continue;
      const Suspect cause = suspect_of(stretch);
      if (std::none_of(verdict.hot_spots.begin(), verdict.hot_spots.end(),
                       [&](const HotSpot& spot) { return is_same(spot.suspect, cause); }))
        verdict.confirmed_stretches.push_back({stretch.first_frame, stretch.last_frame + 1});
    }
  }

  void add_path_spots(std::vector<HotSpot>& spots) const {
    for (const PathSuspect& suspect : path_suspects_) {
      const Suspect cause = suspect_of(suspect);
      if (suspect.kind == PathSuspect::Kind::kUnplaced)
        spots.push_back({HotSpot::Kind::kUnplacedRun, cause.at, std::nullopt, 0, cause});
      if (suspect.kind == PathSuspect::Kind::kUnmatched && suspect.doubt_m >= options_.unconfirmed_m &&
          !is_confirmed(suspect))
        spots.push_back(
            {HotSpot::Kind::kUnmatched, cause.at, options_.unmatched_error * suspect.doubt_m, 0, cause});
    }
  }

  /// Adds the interruptions and gaps after which the robot was misplaced. The error grows with the share of
  /// the walls that contradict the place.
  void add_interruptions(std::vector<HotSpot>& spots) const {
    constexpr double kLeastShare = 0.2;  // of the error, if the place is just doubtful
    for (const InterruptionCheck& check : contradicted_) {
      const double share = std::clamp((check.contradicted - options_.contradiction) /
                                          (options_.sure_contradiction - options_.contradiction),
                                      kLeastShare, 1.0);
      const Suspect cause = suspect_of(check.suspect);
      const bool is_gap = check.suspect.kind == PathSuspect::Kind::kGap;
      spots.push_back({is_gap ? HotSpot::Kind::kGapDisagrees : HotSpot::Kind::kRunsDisagree, cause.at,
                       share * options_.passes.unknown_m, 0, cause});
    }
  }

  void add_uncertain_places(std::vector<HotSpot>& spots) const {
    for (const UncertainStretch& stretch :
         uncertain_stretches(result_, views_, sigmas_m_, options_.uncertain_m)) {
      Suspect cause = this->stretch(Suspect::Kind::kDrift, stretch.first_frame, stretch.last_frame);
      cause.at = place_of(views_[stretch.worst].frame);
      spots.push_back({HotSpot::Kind::kUncertain, cause.at, stretch.sigma_m, stretch.length_m, cause});
    }
  }

  /// Adds the stretches with an open direction, and hot spots for those without odometry. Passes that fit do
  /// not confirm the motion: the way back can have the same error as the way there.
  void add_open_stretches(MapVerdict& verdict) const {
    verdict.open_stretches = open_stretches(result_, views_, options_.unconfirmed_m);
    for (const OpenStretch& open : verdict.open_stretches) {
      if (open.has_odometry) continue;
      const Suspect cause = stretch(Suspect::Kind::kOpen, open.first_frame, open.last_frame);
      verdict.hot_spots.push_back({HotSpot::Kind::kOpenDirection, cause.at,
                                   options_.unmatched_error * open.length_m, open.length_m, cause});
    }
  }

  /// Adds the thickest wall if the walls of passes differ by more than the same wall may, though no
  /// displacement of a pass was found.
  void add_thickest_wall(MapVerdict& verdict) const {
    if (verdict.wall_thickness_m <= options_.passes.scans.margin_m) return;
    const auto thickness_m = [](const PassCheck& check) {
      return check.same_pass ? 0 : check.scans.offset_m;
    };
    const PassCheck& worst = *std::max_element(
        checks_.begin(), checks_.end(),
        [&](const PassCheck& a, const PassCheck& b) { return thickness_m(a) < thickness_m(b); });
    HotSpot spot = spot_of({&worst, worst.view, worst.view, 1}, kind_of(worst));
    spot.error_m = worst.scans.offset_m;
    verdict.hot_spots.push_back(spot);
  }

  bool is_misfit(const PassCheck& check) const {
    return check.fits_if_moved && check.error_m >= options_.misfit_m;
  }

  /// Mean error over the views that other passes or successive scans check.
  double mean_error_m() const {
    std::vector<std::optional<double>> errors = errors_;
    for (const PassCheck& check : checks_)
      if (check.same_pass)
        errors[check.view] = std::max(errors[check.view].value_or(0), is_misfit(check) ? check.error_m : 0.0);
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
      const bool is_misplaced =
          spot.kind == HotSpot::Kind::kGapDisagrees ||
          (spot.kind == HotSpot::Kind::kRunsDisagree && spot.suspect.kind == Suspect::Kind::kLost);
      if (spot.kind == HotSpot::Kind::kUnplacedRun)
        worst_m = std::max(worst_m, error_of_parts_m(spot.suspect.first_frame, options_.passes.unknown_m));
      if (is_misplaced || spot.kind == HotSpot::Kind::kUnmatched)
        worst_m = std::max(worst_m, error_of_parts_m(spot.suspect.first_frame, *spot.error_m));
    }
    return worst_m;
  }

  double mean_prediction_m() const {
    double sum_m = 0;
    std::size_t count = 0;
    for (const std::optional<double>& sigma_m : sigmas_m_) {
      sum_m += sigma_m.value_or(0);
      count += sigma_m ? 1 : 0;
    }
    return count == 0 ? 0 : sum_m / static_cast<double>(count);
  }

  void measure_walls(MapVerdict& verdict) const {
    const auto checked = static_cast<double>(std::count_if(
        errors_.begin(), errors_.end(), [](const auto& error_m) { return error_m.has_value(); }));
    if (!views_.empty()) verdict.checked_share = checked / static_cast<double>(views_.size());
    verdict.held_share = held_share(views_, checks_, options_.spot_error_m);
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
  bool searched_loops_ = false;                  // by any scan
  std::vector<std::optional<double>> sigmas_m_;  // predicted for each view
  std::vector<InterruptionCheck> contradicted_;  // interruptions after which the robot was misplaced
  std::vector<double> blame_;                    // of the step after each view
  // First frames of the checks that fit, ascending, with the largest last frame of all checks up to here.
  std::vector<std::pair<std::size_t, std::size_t>> fitting_reach_;
};

}  // namespace

MapVerdict judge_map(const MappingResult& result, const VerdictOptions& options) {
  return Judge(result, options).verdict();
}

}  // namespace psi_slam
