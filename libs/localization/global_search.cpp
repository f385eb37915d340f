// SPDX-License-Identifier: BSD-3-Clause
#include "localization/global_search.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/number_text.h"
#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

// Share of min_response that the coarse search needs. It is below 1, because large cells score less, and
// because rejected places are reported too.
constexpr double kSearchedShare = 0.9;
// The exact search that checks a place starts at this share of its response, which allows for rounding.
constexpr double kCheckedShare = 0.999;
constexpr double kFineWindow_rad = radians_from_degrees(2.0L);

// Other places with a response below this share of the best response are ignored.
constexpr double kLeastAmbiguity = 0.75;

MatcherOptions with_quick_ambiguity(MatcherOptions options) {
  options.ambiguity_floor = std::max(options.ambiguity_floor, kLeastAmbiguity);
  return options;
}

constexpr int kWallScore = 160;      // of 255; reached inside a wall, but not beside it
constexpr double kSurface_m = 0.25;  // a wall this close in front of the hit surface counts as that surface
// A wall blocks a beam only if it continues this far to both sides of the beam, in metres and in cells.
// Specks do not block beams, and neither do the thick ends of walls that a beam passes.
constexpr double kBeside_m = 0.1;
constexpr double kBesideCells = 2;
// Walls beside the beam are searched this many times as far along it, so that walls block beams that cross
// them at 27 degrees or more.
constexpr double kAlongBeside = 2;
constexpr double kLeastIncidence = 0.05;  // lower bound of the sine of the angle between beam and wall
constexpr double kNoSurface = 0.5;        // sine of the angle between beam and wall without a surface normal

/// Returns the length, in metres, of the end part of a beam in which walls count as the surface that it hit.
/// (dx, dy) is the unit direction of the beam in the robot's frame.
double tolerance_m(const ScanPoints& scan, std::size_t i, double dx, double dy) {
  double incidence = kNoSurface;
  if (!scan.normals.empty() && (scan.normals[i].x != 0 || scan.normals[i].y != 0))
    incidence =
        std::abs(dx * static_cast<double>(scan.normals[i].x) + dy * static_cast<double>(scan.normals[i].y));
  return kSurface_m / std::max(incidence, kLeastIncidence);
}

std::string two_decimals(double value) {
  return fixed_text(value, 2);
}

}  // namespace

ClearBeams clear_beams(const ScoreGrid& map, const ScanPoints& scan, const mrpt::math::TPose2D& map_T_robot) {
  ClearBeams result;
  const double cells_per_m = 1 / map.resolution_m();
  const double beside = std::max(kBeside_m * cells_per_m, kBesideCells);
  const double c = portable::cos(map_T_robot.phi);
  const double s = portable::sin(map_T_robot.phi);
  for_each_laser(scan, [&](const mrpt::math::TPoint2Df& origin, std::size_t first, std::size_t last) {
    const auto origin_x = static_cast<double>(origin.x);
    const auto origin_y = static_cast<double>(origin.y);
    const double x0 = (map_T_robot.x + c * origin_x - s * origin_y - map.origin_x_m()) * cells_per_m;
    const double y0 = (map_T_robot.y + s * origin_x + c * origin_y - map.origin_y_m()) * cells_per_m;
    for (std::size_t i = first; i < last; ++i) {
      const double bx = static_cast<double>(scan.points[i].x) - origin_x;
      const double by = static_cast<double>(scan.points[i].y) - origin_y;
      const double range_m = portable::hypot(bx, by);
      if (range_m <= 0) continue;
      const double dx = bx / range_m;
      const double dy = by / range_m;
      const double step_x = c * dx - s * dy;
      const double step_y = s * dx + c * dy;
      const double end = (range_m - tolerance_m(scan, i, dx, dy)) * cells_per_m;
      const auto is_wall = [&](double t, double left) {
        return map.finest().at(floor_to_int(x0 + t * step_x - left * step_y),
                               floor_to_int(y0 + t * step_y + left * step_x)) >= kWallScore;
      };
      const auto is_wall_beside = [&](double t, double left) {
        bool found = false;
        for (double along = -kAlongBeside * beside; along <= kAlongBeside * beside && !found; along += 1)
          found = is_wall(t + along, left);
        return found;
      };
      bool clear = true;
      for (double t = 0; t < end && clear; t += 1)
        clear = !is_wall(t, 0) || !is_wall_beside(t, beside) || !is_wall_beside(t, -beside);
      ++result.beams;
      if (clear) ++result.clear;
    }
  });
  return result;
}

WholeMapMatch match_whole_map(const Matcher& matcher, const WholeMapProblem& problem,
                              const MatcherOptions& options) {
  const ScoreGrid& grid = problem.grid;
  const double half_x_m = 0.5 * grid.finest().width() * grid.resolution_m();
  const double half_y_m = 0.5 * grid.finest().height() * grid.resolution_m();
  const TPose2D middle(grid.origin_x_m() + half_x_m, grid.origin_y_m() + half_y_m, problem.centre_rad);
  MatchProblem window{grid, problem.scan, middle, {half_x_m, half_y_m, M_PI}};
  window.min_response = problem.min_response;
  window.measure_ambiguity = true;
  window.seed = problem.seed;
  MatchResult match = matcher.match(window);
  const double turn_rad = std::abs(mrpt::math::wrapToPi(match.lattice_pose.phi - problem.centre_rad));
  if (!match.found || turn_rad < M_PI - options.distinct_rad) return {match, problem.centre_rad};
  const std::int64_t evaluations = match.evaluations;
  window.map_T_robot.phi = mrpt::math::wrapToPi(problem.centre_rad + M_PI);
  // The headings of the repeated search may miss the best heading by up to half a step.
  window.min_response = std::min(problem.min_response, kSearchedShare * match.response);
  match = matcher.match(window);
  match.evaluations += evaluations;
  return {match, window.map_T_robot.phi};
}

GlobalSearch::GlobalSearch(ReferenceMap map, const GlobalSearchOptions& options)
    : map_(std::move(map)),
      options_(options),
      matcher_(make_matcher(options.matcher, with_quick_ambiguity(options.match), options.genetic)),
      exact_matcher_(with_quick_ambiguity(options.match)),
      fine_matcher_(options.match) {}

FoundPlace GlobalSearch::find(std::size_t node, const KeyframeStore& memory, const MatchSeed& seed) const {
  const ScanPoints context = scan_context(node, memory, options_.context);
  if (context.points.empty() || context.farthest_m <= map_.coarse->scores().resolution_m()) {
    FoundPlace place;
    place.objection = "the scan has no points";
    return place;
  }
  const WholeMapMatch somewhere = match_whole_map(
      *matcher_, {map_.coarse->scores(), context, kSearchedShare * options_.min_response, 0, seed},
      options_.match);
  FoundPlace place = judge(somewhere.match, context, node, memory);
  if (!place.believed() || options_.matcher == MatcherKind::kCsm) return place;

  // A genetic search may have missed a place that fits as well or better. The exact search finds it, and it
  // is fast, because it need not consider places with lower responses. It begins in the window in which the
  // response was reached, because a window with another centre has other headings.
  const std::int64_t evaluations = place.evaluations;
  const WholeMapMatch checked = match_whole_map(
      exact_matcher_,
      {map_.coarse->scores(), context, kCheckedShare * somewhere.match.response, somewhere.centre_rad, seed},
      options_.match);
  place = judge(checked.match, context, node, memory);
  place.evaluations += evaluations;
  return place;
}

FoundPlace GlobalSearch::judge(const MatchResult& somewhere, const ScanPoints& context, std::size_t node,
                               const KeyframeStore& memory) const {
  FoundPlace place;
  place.evaluations = somewhere.evaluations;
  if (!somewhere.found) {
    place.objection = "no place of the map fits";
    return place;
  }
  place.found = true;
  place.map_T_robot = somewhere.map_T_robot;
  place.response = somewhere.response;
  place.ambiguity = somewhere.ambiguity.value_or(0);
  const double window_m = kFineCells * map_.coarse->scores().resolution_m();
  const MatchResult exactly = fine_matcher_.match(
      {map_.fine->scores(), context, somewhere.map_T_robot, {window_m, window_m, kFineWindow_rad}});
  place.evaluations += exactly.evaluations;
  if (exactly.found) {
    place.map_T_robot = exactly.map_T_robot;
    place.response = exactly.response;
  }
  place.objection = objection(place, context, node, memory);
  return place;
}

// Returns the least share of clear beams of a place. Specks and moved furniture block many beams at the true
// place, but there no other place comes near. Where one does, the beams must decide between them.
double GlobalSearch::least_clear_share(double ambiguity) const {
  const double rivalry = std::clamp(
      (ambiguity - kLeastAmbiguity) / std::max(options_.max_ambiguity - kLeastAmbiguity, 1e-3), 0.0, 1.0);
  return (1 - rivalry) * options_.min_clear_share_alone + rivalry * options_.min_clear_share;
}

std::string GlobalSearch::objection(FoundPlace& place, const ScanPoints& context, std::size_t node,
                                    const KeyframeStore& memory) const {
  if (place.response < options_.min_response)
    return "no place of the map fits: the response of the best place is " + two_decimals(place.response) +
           ", less than " + two_decimals(options_.min_response);

  const LocalMap::Agreement all = map_.fine->agreement(context, place.map_T_robot);
  place.observed_share = static_cast<double>(all.observed) / static_cast<double>(context.points.size());
  LocalMap::Agreement forward;
  ClearBeams beams;
  const NodeScan& here = memory.nodes[node];
  for (std::size_t i = node + 1; i-- > 0;) {
    const NodeScan& there = memory.nodes[i];
    if (here.travelled_m - there.travelled_m > options_.context.travel_m) break;
    if (!there.points) continue;
    const TPose2D map_T_there = compose(place.map_T_robot, between(here.local_T_robot, there.local_T_robot));
    const LocalMap::Agreement one = map_.fine->agreement(*there.points, map_T_there);
    forward.observed += one.observed;
    forward.hits += one.hits;
    const ClearBeams more = clear_beams(map_.fine->scores(), *there.points, map_T_there);
    beams.clear += more.clear;
    beams.beams += more.beams;
  }
  place.agree = forward.share();
  place.clear_share = beams.share();
  if (place.observed_share < options_.min_observed_share)
    return "only " + two_decimals(place.observed_share) +
           " of the scans' points lie in space that the map shows";
  if (place.agree < options_.min_agree)
    return "no place of the map fits: at the best place, only " + two_decimals(place.agree) +
           " of the scans' points lie on walls";
  if (place.clear_share < least_clear_share(place.ambiguity))
    return "no place of the map fits: at the best place, only " + two_decimals(place.clear_share) +
           " of the beams pass through no wall";
  place.ambiguous = place.ambiguity > options_.max_ambiguity;
  if (place.ambiguous)
    return "another place fits as well: its response is " + two_decimals(place.ambiguity) + " of the best";
  return {};
}

}  // namespace psi_slam
