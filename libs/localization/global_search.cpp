// SPDX-License-Identifier: BSD-3-Clause
#include "localization/global_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/number_text.h"
#include "localization/clear_beams.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

// Share of min_response that the coarse search needs: large cells score less, and rejected places are
// reported.
constexpr double kSearchedShare = 0.9;
constexpr double kFineCells = 1.5;  // half-width of the window in the fine grid, in coarse cells
constexpr double kFineWindow_rad = radians_from_degrees(2.0L);

// Other places below this share of the best are ignored: they do not prevent belief in the best.
constexpr double kLeastAmbiguity = 0.75;

MatcherOptions with_quick_ambiguity(MatcherOptions options) {
  options.ambiguity_floor = std::max(options.ambiguity_floor, kLeastAmbiguity);
  return options;
}

/// Window of the whole map and all headings.
struct Everywhere {
  TPose2D middle;
  SearchExtent extent;
};

Everywhere all_of(const ScoreGrid& grid) {
  const double half_x_m = 0.5 * grid.finest().width() * grid.resolution_m();
  const double half_y_m = 0.5 * grid.finest().height() * grid.resolution_m();
  return {{grid.origin_x_m() + half_x_m, grid.origin_y_m() + half_y_m, 0}, {half_x_m, half_y_m, M_PI}};
}

std::string two_decimals(double value) {
  return fixed_text(value, 2);
}

/// Calls `visit` for the node and for the nodes of its context.
template <class Visit>
void for_context(std::size_t node, const KeyframeStore& memory, double travel_m, const Visit& visit) {
  const NodeScan& here = memory.nodes[node];
  for (std::size_t i = node + 1; i-- > 0;) {
    const NodeScan& there = memory.nodes[i];
    if (here.travelled_m - there.travelled_m > travel_m) break;
    visit(there, there.local_T_robot - here.local_T_robot);
  }
}

}  // namespace

GlobalSearch::GlobalSearch(ReferenceMap map, const GlobalSearchOptions& options)
    : map_(std::move(map)),
      options_(options),
      matcher_(make_matcher(options.matcher, with_quick_ambiguity(options.match), options.genetic)),
      fine_matcher_(options.match) {}

FoundPlace GlobalSearch::find(std::size_t node, const KeyframeStore& memory, const MatchSeed& seed) const {
  FoundPlace place;
  const ScanPoints context = scan_context(node, memory, options_.context);
  const ScoreGrid& coarse = map_.coarse->scores();
  if (context.points.empty() || context.farthest_m <= coarse.resolution_m()) {
    place.objection = "the scan has no points";
    return place;
  }
  const MatchResult somewhere = match_anywhere(context, seed);
  place.evaluations = somewhere.evaluations;
  if (!somewhere.found) {
    place.objection = "no place of the map fits";
    return place;
  }
  place.found = true;
  place.map_T_robot = somewhere.map_T_robot;
  place.response = somewhere.response;
  place.ambiguity = somewhere.ambiguity.value_or(0);
  const double window_m = kFineCells * coarse.resolution_m();
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

// If the best heading lies near +-180 degrees, it is found on both sides and looks ambiguous. The search is
// then repeated with a window centred on 180 degrees.
MatchResult GlobalSearch::match_anywhere(const ScanPoints& context, const MatchSeed& seed) const {
  const ScoreGrid& grid = map_.coarse->scores();
  const Everywhere everywhere = all_of(grid);
  MatchProblem problem{grid, context, everywhere.middle, everywhere.extent};
  problem.min_response = kSearchedShare * options_.min_response;
  problem.measure_ambiguity = true;
  problem.seed = seed;
  MatchResult match = matcher_->match(problem);
  if (!match.found || std::abs(match.lattice_pose.phi) < M_PI - options_.match.distinct_rad) return match;
  const std::int64_t evaluations = match.evaluations;
  problem.map_T_robot.phi = M_PI;
  match = matcher_->match(problem);
  match.evaluations += evaluations;
  return match;
}

std::string GlobalSearch::objection(FoundPlace& place, const ScanPoints& context, std::size_t node,
                                    const KeyframeStore& memory) const {
  if (place.response < options_.min_response)
    return "no place of the map fits: the best one's response is " + two_decimals(place.response) +
           ", less than " + two_decimals(options_.min_response);

  const LocalMap::Agreement all = map_.fine->agreement(context, place.map_T_robot);
  place.observed_share = static_cast<double>(all.observed) / static_cast<double>(context.points.size());
  LocalMap::Agreement forward;
  ClearBeams beams;
  for_context(node, memory, options_.context.travel_m,
              [&](const NodeScan& there, const TPose2D& here_T_there) {
                const TPose2D map_T_there = place.map_T_robot + here_T_there;
                const LocalMap::Agreement one = map_.fine->agreement(*there.points, map_T_there);
                forward.observed += one.observed;
                forward.hits += one.hits;
                const ClearBeams more = clear_beams(map_.fine->scores(), *there.points, map_T_there);
                beams.clear += more.clear;
                beams.beams += more.beams;
              });
  place.agree = forward.share();
  place.clear_share = beams.share();
  if (place.observed_share < options_.min_observed_share)
    return "only " + two_decimals(place.observed_share) +
           " of the scans' points lie in space that the map shows";
  if (place.agree < options_.min_agree)
    return "no place of the map fits: at the best one only " + two_decimals(place.agree) +
           " of the scans' points lie on its walls";
  if (place.clear_share < options_.min_clear_share)
    return "no place of the map fits: at the best one only " + two_decimals(place.clear_share) +
           " of the beams pass through no wall";
  place.ambiguous = place.ambiguity > options_.max_ambiguity;
  if (place.ambiguous)
    return "another place fits as well: its response is " + two_decimals(place.ambiguity) + " of the best";
  return {};
}

}  // namespace psi_slam
