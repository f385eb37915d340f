// SPDX-License-Identifier: BSD-3-Clause
#include "map/verdict/pass_checks.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"
#include "matching/point_grid.h"

namespace psi_slam {
namespace {

constexpr double kFits = 0.8;  // share of the same walls from which two scans fit
// When the nearest views are chosen, a turn by this angle counts like a distance of one metre.
constexpr double kRadiansPerMetre = 1.0;
constexpr double kCell_m = 0.5;
constexpr std::size_t kViewsOfPlace = 8;

mrpt::math::TPoint2Df position(const MapView& view) {
  return {static_cast<float>(view.map_T_robot.x), static_cast<float>(view.map_T_robot.y)};
}

/// Whether enough points remain in view after the alignment to judge it.
bool is_alignment_judged(const ScanComparison& scans, const PassCheckOptions& options) {
  return scans.compared_if_moved >= options.min_points;
}

/// Displacement by the alignment, with its turn at the lever.
double moved_m(const ScanComparison& scans, const PassCheckOptions& options) {
  return portable::hypot(scans.displacement_m, options.lever_m * scans.turn_rad);
}

double estimated_error_m(const ScanComparison& scans, const PassCheckOptions& options) {
  const bool judged = is_alignment_judged(scans, options);
  const double same = judged ? scans.same_if_moved : 1 - scans.seen_through_share();
  if (same >= kFits) return judged ? std::min(moved_m(scans, options), options.unknown_m) : 0;
  // Doors and furniture that moved lower the shares of true pairs, so the error grows with the misfit.
  return options.unknown_m * std::clamp((kFits - same) / (kFits - 0.5), 0.0, 1.0);
}

/// Indices of the views that serve for comparison: the first kViewsOfPlace in each cell of kCell_m whose
/// headings share an eighth of the circle.
std::vector<std::size_t> views_to_compare(const std::vector<MapView>& views) {
  std::map<std::array<long, 3>, std::size_t> counts;
  std::vector<std::size_t> chosen;
  for (std::size_t view = 0; view < views.size(); ++view) {
    const mrpt::math::TPose2D& pose = views[view].map_T_robot;
    const std::array<long, 3> place{std::lround(pose.x / kCell_m), std::lround(pose.y / kCell_m),
                                    std::lround(mrpt::math::wrapTo2Pi(pose.phi) * 4 / M_PI) % 8};
    if (counts[place]++ < kViewsOfPlace) chosen.push_back(view);
  }
  return chosen;
}

/// Indices of the best views of other passes near a view: at most one view of each pass.
std::vector<std::size_t> views_of_other_passes(std::size_t view, const std::vector<MapView>& views,
                                               const std::vector<std::size_t>& candidates,
                                               const PointGrid& positions, const PassCheckOptions& options) {
  const MapView& here = views[view];
  std::vector<std::pair<double, std::size_t>> near;
  for (const std::size_t near_one : positions.within(position(here), static_cast<float>(options.reach_m))) {
    const std::size_t other = candidates[near_one];
    const MapView& there = views[other];
    if (!are_different_passes(here, there, options.pass_apart_m)) continue;
    const double turn_rad = std::abs(mrpt::math::wrapToPi(there.map_T_robot.phi - here.map_T_robot.phi));
    near.emplace_back(distance_m(here.map_T_robot, there.map_T_robot) + turn_rad / kRadiansPerMetre, other);
  }
  std::sort(near.begin(), near.end());
  std::vector<std::size_t> chosen;
  for (const auto& [cost, other] : near) {
    if (chosen.size() == options.passes) break;
    const auto is_of_pass = [&, candidate = other](std::size_t before) {
      return !are_different_passes(views[candidate], views[before], options.pass_apart_m);
    };
    if (std::none_of(chosen.begin(), chosen.end(), is_of_pass)) chosen.push_back(other);
  }
  return chosen;
}

/// Whether other views of both passes of a check fit at the poses of the map: then one of the passes is not
/// at a place that merely looks like the place of the other.
bool passes_fit(std::size_t of_check, const std::vector<MapView>& views, const std::vector<PassCheck>& checks,
                const PassCheckOptions& options) {
  const PassCheck& check = checks[of_check];
  const auto is_near = [&](std::size_t a, std::size_t b) {
    return !are_different_passes(views[a], views[b], options.pass_apart_m);
  };
  const auto fits = [&](const PassCheck& one) {
    return one.same_pass == check.same_pass && one.fits_if_moved && one.error_m <= options.scans.margin_m &&
           is_near(one.other, check.other);
  };
  for (std::size_t i = of_check; i-- > 0 && is_near(checks[i].view, check.view);)
    if (fits(checks[i])) return true;
  for (std::size_t i = of_check + 1; i < checks.size() && is_near(checks[i].view, check.view); ++i)
    if (fits(checks[i])) return true;
  return false;
}

}  // namespace

bool fits_after_alignment(const ScanComparison& scans, const PassCheckOptions& options) {
  return is_alignment_judged(scans, options) && scans.same_if_moved >= kFits;
}

std::optional<PassCheck> compare_views(const std::vector<MapView>& views, std::size_t view, std::size_t other,
                                       bool same_pass, const PassCheckOptions& options) {
  PassCheck check;
  check.view = view;
  check.other = other;
  check.same_pass = same_pass;
  check.scans = compare_scans(views[view], views[other], options.scans);
  if (check.scans.same + check.scans.seen_through < options.min_points) return std::nullopt;
  check.error_m = estimated_error_m(check.scans, options);
  check.fits_if_moved = fits_after_alignment(check.scans, options);
  check.scene_changed = check.error_m > 0 && !check.fits_if_moved && check.scans.is_held &&
                        moved_m(check.scans, options) <= options.scans.margin_m;
  return check;
}

std::vector<PassCheck> check_passes(const std::vector<MapView>& views, const PassCheckOptions& options) {
  const std::vector<std::size_t> candidates = views_to_compare(views);
  std::vector<mrpt::math::TPoint2Df> at;
  for (const std::size_t view : candidates) at.push_back(position(views[view]));
  const PointGrid positions(std::move(at), options.reach_m);
  std::vector<PassCheck> checks;
  const auto compare = [&](std::size_t view, std::size_t other, bool same_pass) {
    if (auto check = compare_views(views, view, other, same_pass, options)) checks.push_back(*check);
  };
  for (std::size_t view = 0; view < views.size(); ++view) {
    for (const std::size_t other : views_of_other_passes(view, views, candidates, positions, options))
      compare(view, other, false);
    if (view >= options.views_back && views[view - options.views_back].run == views[view].run)
      compare(view, view - options.views_back, true);
  }
  std::vector<std::size_t> changed;
  for (std::size_t i = 0; i < checks.size(); ++i)
    if (checks[i].scene_changed && passes_fit(i, views, checks, options)) changed.push_back(i);
  for (PassCheck& check : checks) check.scene_changed = false;
  for (const std::size_t i : changed) {
    checks[i].scene_changed = true;
    checks[i].error_m = 0;
  }
  return checks;
}

std::vector<std::optional<double>> errors_of_views(std::size_t views, const std::vector<PassCheck>& checks) {
  std::vector<std::optional<double>> errors(views);
  for (const PassCheck& check : checks)
    if (!check.same_pass && !check.scene_changed)
      errors[check.view] = std::max(errors[check.view].value_or(0), check.error_m);
  return errors;
}

}  // namespace psi_slam
