// SPDX-License-Identifier: BSD-3-Clause
#include "localization/comparison/map_alignment.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "base/portable_math.h"
#include "localization/global_search.h"
#include "localization/reference_map.h"
#include "logs/frames/pose_operations.h"
#include "logs/frames/position_variance.h"
#include "map/rendering/map_image.h"
#include "matching/make_matcher.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using Grid = mrpt::maps::COccupancyGridMap2D;
using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kLeastCoarse_m = 0.1;  // smallest cell of the grid in which the whole map is searched
constexpr double kCoarseCells = 300;    // largest number of coarse cells along the larger map
constexpr double kCoarseResponse = 0.3;
// Neighbouring wall cells show the same surface. Points farther apart than this count as independent.
constexpr double kPointSpacing_m = 0.2;
constexpr std::size_t kMostPoints = 2000;  // of the fine match; a coarse match takes a quarter
constexpr double kDistinctCells = 5;       // two alignments are distinct beyond this many coarse cells
constexpr double kLeastDistinct_m = 1;

/// The walls of a map as the points of one scan, in metres around their mean.
struct Walls {
  ScanPoints points;
  TPoint2D centre{0, 0};  ///< mean in the map's frame; the origin of the points
};

std::vector<TPoint2D> wall_cells(const Grid& map) {
  std::vector<TPoint2D> cells;
  for (int y = 0; y < static_cast<int>(map.getSizeY()); ++y) {
    const Grid::cellType* row = map.getRow(y);
    for (int x = 0; x < static_cast<int>(map.getSizeX()); ++x)
      if (is_occupied(row[x]))
        cells.emplace_back(static_cast<double>(map.idx2x(x)), static_cast<double>(map.idx2y(y)));
  }
  return cells;
}

/// Keeps one of the points in each square of `spacing_m`. Doubles the spacing until at most `most` are left.
std::vector<TPoint2D> thinned(const std::vector<TPoint2D>& points, double spacing_m, std::size_t most) {
  std::vector<TPoint2D> kept;
  std::set<std::pair<int, int>> taken;
  for (const TPoint2D& point : points)
    if (taken.emplace(floor_to_int(point.x / spacing_m), floor_to_int(point.y / spacing_m)).second)
      kept.push_back(point);
  return kept.size() <= most ? kept : thinned(kept, 2 * spacing_m, most);
}

Walls walls_of(const std::vector<TPoint2D>& cells, std::size_t most) {
  const std::vector<TPoint2D> points = thinned(cells, kPointSpacing_m, most);
  Walls walls;
  for (const TPoint2D& point : points) walls.centre += point;
  walls.centre /= static_cast<double>(points.size());
  for (const TPoint2D& point : points) {
    const TPoint2D offset = point - walls.centre;
    walls.points.points.emplace_back(static_cast<float>(offset.x), static_cast<float>(offset.y));
    walls.points.farthest_m = std::max(walls.points.farthest_m, portable::hypot(offset.x, offset.y));
  }
  return walls;
}

/// A match of the walls of the smaller map with the larger map.
struct WallMatch {
  MatchResult match;  ///< its poses are those of the walls' centre in the larger map
  LocalMap::Agreement agreement;
  double observed_share = 0;
};

/// Matches the walls of a map with another map.
class WallMatcher {
 public:
  WallMatcher(const Grid& map, const std::vector<TPoint2D>& cells)
      : walls_(walls_of(cells, kMostPoints)), few_walls_(walls_of(cells, kMostPoints / 4)) {
    const double longer_m = std::max(static_cast<double>(map.getXMax() - map.getXMin()),
                                     static_cast<double>(map.getYMax() - map.getYMin()));
    map_ = make_reference_map(map, std::max(kLeastCoarse_m, longer_m / kCoarseCells), kFineSmoothing_m);
    few_walls_.points.farthest_m = std::max(few_walls_.points.farthest_m, coarse_m());
  }

  const Walls& walls() const { return walls_; }
  /// Whether all walls lie within one cell of their mean, so that their heading is unknown.
  bool too_few_walls() const { return !(walls_.points.farthest_m > map_.fine->scores().resolution_m()); }

  /// Finds the pose of the map with the walls in the other map, near `map_T_walls`, the pose of its frame.
  WallMatch near(const TPose2D& map_T_walls, double window_m, double window_rad) const {
    return refined(compose(map_T_walls, TPose2D(walls_.centre.x, walls_.centre.y, 0)), window_m, window_rad);
  }

  /// Searches the other map at all headings. Empty if nothing fits.
  std::optional<WallMatch> anywhere() const {
    MatcherOptions options;
    options.distinct_m = std::max(kLeastDistinct_m, kDistinctCells * coarse_m());
    const CorrelativeMatcher matcher(options);
    const MatchResult coarse =
        match_whole_map(matcher, {map_.coarse->scores(), few_walls_.points, kCoarseResponse}, options).match;
    if (!coarse.found) return std::nullopt;
    const TPoint2D between = walls_.centre - few_walls_.centre;
    WallMatch fine = refined(compose(coarse.map_T_robot, TPose2D(between.x, between.y, 0)),
                             kFineCells * coarse_m(), kFineCells * coarse_m() / few_walls_.points.farthest_m);
    fine.match.ambiguity = coarse.ambiguity;
    return fine;
  }

 private:
  double coarse_m() const { return map_.coarse->scores().resolution_m(); }

  /// Compares the walls with the other map at the pose of their centre.
  WallMatch judged(const MatchResult& match) const {
    WallMatch result{match, map_.fine->agreement(walls_.points, match.map_T_robot), 0};
    result.observed_share =
        static_cast<double>(result.agreement.observed) / static_cast<double>(walls_.points.points.size());
    return result;
  }

  WallMatch refined(const TPose2D& map_T_centre, double window_m, double window_rad) const {
    const CorrelativeMatcher matcher{MatcherOptions()};
    return judged(
        matcher.match({map_.fine->scores(), walls_.points, map_T_centre, {window_m, window_m, window_rad}}));
  }

  Walls walls_;
  Walls few_walls_;
  ReferenceMap map_;
};

/// The pose of map B in map A from a match of the walls of A in B (`swapped`) or of B in A.
MapAlignment alignment_of(const WallMatch& found, const Walls& walls, bool swapped) {
  const TPose2D large_T_small =
      compose(found.match.map_T_robot, TPose2D(-walls.centre.x, -walls.centre.y, 0));
  MapAlignment alignment;
  alignment.a_T_b = swapped ? inverse(large_T_small) : large_T_small;
  alignment.centre = swapped ? walls.centre : TPoint2D(found.match.map_T_robot.x, found.match.map_T_robot.y);
  // A swapped match has its errors along the axes of B, with the opposite sign.
  Eigen::Matrix3d a_R_match = Eigen::Matrix3d::Identity();
  if (swapped) a_R_match.topLeftCorner<2, 2>() = rotation_matrix(alignment.a_T_b.phi);
  alignment.covariance = a_R_match * found.match.covariance * a_R_match.transpose();
  alignment.agree = found.agreement.share();
  return alignment;
}

std::string percent(double share) {
  return fixed_text(100 * share, 0) + " %";
}

/// Returns why a match is no alignment, a sentence that begins with a verb; empty if it is one.
std::string objection(const std::optional<WallMatch>& found, const MapAlignmentOptions& options) {
  if (!found || !found->match.found) return "does not fit: no pose makes the walls of both maps agree";
  if (found->observed_share < options.min_observed_share)
    return "does not fit: at the best alignment, only " + percent(found->observed_share) +
           " of the walls of the smaller map lie in space that the other map shows, expected at least " +
           percent(options.min_observed_share);
  if (found->agreement.share() < options.min_agree)
    return "does not fit: at the best alignment, only " + percent(found->agreement.share()) +
           " of the walls that both maps could show agree, expected at least " + percent(options.min_agree);
  if (found->match.ambiguity.value_or(0) > options.max_ambiguity)
    return "cannot be aligned: another alignment fits nearly as well, with " +
           percent(*found->match.ambiguity) + " of the best response";
  return {};
}

}  // namespace

double MapAlignment::sigma_m(double distance_m) const {
  return std::sqrt(std::max(0.0, largest_position_variance_m2(covariance)) +
                   distance_m * distance_m * covariance(2, 2));
}

MapAlignment align_maps(const Grid& a, const Grid& b, const MapAlignmentOptions& options) {
  const std::vector<TPoint2D> cells_a = wall_cells(a);
  const std::vector<TPoint2D> cells_b = wall_cells(b);
  const bool swapped = cells_a.size() < cells_b.size();
  const WallMatcher matcher(swapped ? b : a, swapped ? cells_a : cells_b);
  if (matcher.too_few_walls())
    throw UserError(std::string(swapped ? "cannot be aligned: the first map has too few walls"
                                        : "has too few walls to be aligned") +
                    ", expected walls over more than one cell");
  const TPose2D a_T_b = options.a_T_b.value_or(TPose2D(0, 0, 0));
  std::optional<WallMatch> found =
      matcher.near(swapped ? inverse(a_T_b) : a_T_b, options.near_m, options.near_rad);
  std::string why_not = objection(found, options);
  auto method = MapAlignment::Method::kNearby;
  const double near_agree = why_not.empty() ? found->agreement.share() : 0;
  if (!options.a_T_b && near_agree < options.min_agree_in_same_frame) {
    // Bent maps with equal frames may agree less. They are equal unless another place fits better.
    std::optional<WallMatch> somewhere = matcher.anywhere();
    const std::string why_not_there = objection(somewhere, options);
    if (near_agree == 0 || (why_not_there.empty() && somewhere->agreement.share() > near_agree)) {
      found = std::move(somewhere);
      why_not = why_not_there;
      method = MapAlignment::Method::kWholeMap;
    }
  }
  if (!why_not.empty())
    throw UserError(why_not + (options.a_T_b ? ". Correct the pose of --start"
                                             : ". Compare maps of one building, or give the rough pose of "
                                               "the second map in the first with --start X,Y,YAW_DEG"));
  MapAlignment alignment = alignment_of(*found, matcher.walls(), swapped);
  alignment.method = method;
  alignment.ambiguity = found->match.ambiguity;
  return alignment;
}

}  // namespace psi_slam
