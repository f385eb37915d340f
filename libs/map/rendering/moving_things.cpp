// SPDX-License-Identifier: BSD-3-Clause
#include "map/rendering/moving_things.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>

#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;
using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kInterval_s = 1;
constexpr double kInterval_m = 0.08;
constexpr std::uint32_t kGapOfVisits = 20;  // intervals that do not see the cell
constexpr double kNear_m = 0.12;
constexpr double kNearCells = 1.5;  // coarse cells: at least the eight cells around
constexpr double kBeyond_m = 0.2;
constexpr double kAside_m = 0.15;      // distance from a straight obstacle at which a beam starts and ends
constexpr double kMostRange_m = 12;    // farther away, errors of the heading move beams by more than kNear_m
constexpr double kFullRange_m = 5;     // beams weigh less beyond
constexpr double kTube_m = 0.12;       // radius of the space around a beam that its neighbours must find free
constexpr double kWidestGap_m = 0.3;   // between the points where neighbouring beams meet an obstacle
constexpr double kBeamsPerMetre = 60;  // of cell, for one free interval
constexpr double kOneCell_m = 0.05;    // size of the cells near which beams count in full
constexpr float kMostOfVisit = 12;     // weight of free intervals
constexpr float kReturn = 0.9F;        // free weight after which a hit counts as a return; less is forgotten
constexpr double kStraightReach_m = 0.3;  // reach of the cells whose line gives the normal
constexpr double kStraightRatio = 0.1;    // of the variances across and along a straight obstacle
constexpr double kSurfaceGap_m = 0.25;    // largest distance between the ends of neighbouring beams
constexpr double kSurfaceSpacings = 4;    // or multiple of the distance between the beams there
constexpr std::uint16_t kMostCount = 60'000;
constexpr double kPathStep_m = 0.5;  // shorter motions may be errors of the poses of a standing robot
constexpr double kPass_m = 8;        // path between two passes
constexpr double kPlace_m = 3;       // from a place of the path, the robot is still there, or again
constexpr double kStay_s = 30;       // few people stand longer than this
constexpr double kLeastBeams = 2;    // that must see more obstacles than are crossed

/// Returns the mean angle between neighbouring beams, or 0 for a single beam.
double beam_gap_rad(const Fan& fan) {
  if (!fan.bearings || fan.bearings->size() < 2) return 0;
  return std::abs(static_cast<double>(fan.bearings->back() - fan.bearings->front())) /
         static_cast<double>(fan.bearings->size() - 1);
}

/// Returns whether a beam that ends before `range_m` passes within kTube_m of a beam at this range, or is its
/// neighbour.
bool is_narrow(const std::vector<double>& clear_m, std::size_t beam, double range_m, double gap_rad) {
  const double beams = kTube_m / std::max(1e-6, gap_rad * range_m);
  const auto reach = static_cast<std::size_t>(std::clamp(beams, 1.0, static_cast<double>(clear_m.size())));
  const std::size_t end = std::min(clear_m.size(), beam + reach + 1);
  for (std::size_t i = beam - std::min(beam, reach); i < end; ++i)
    if (clear_m[i] < range_m) return true;
  return false;
}

// Returns the share with which the beams through each cell near a cell count. A beam counts once for each
// near cell that it crosses. These are more in smaller cells, where fewer beams weigh 1, too.
float share_of_near(double resolution_m) {
  const double cells = resolution_m / kOneCell_m;
  return static_cast<float>(cells < 1 ? cells * cells : 1 / cells);
}

/// Returns the one of two obstacles that has been seen in its state for longer; null if none was seen.
template <class Cell>
const Cell* older(const Cell* other, const Cell& cell) {
  if (cell.hits == 0) return other;
  return other != nullptr && other->occupied_since.path_m <= cell.occupied_since.path_m ? other : &cell;
}

/// Shows those cells as occupied that are farther than `near` from all obstacles of the map, and those around
/// them. The others are rims of walls. Returns `grid`.
const COccupancyGridMap2D& show_new_obstacles(const std::vector<NewObstacle>& new_obstacles,
                                              std::int64_t near, COccupancyGridMap2D& grid) {
  if (new_obstacles.empty()) return grid;
  const ObstacleField obstacles(grid);
  const auto width = static_cast<std::int64_t>(grid.getSizeX());
  for (const NewObstacle& cell : new_obstacles) {
    const auto index = static_cast<std::size_t>(cell.y * width + cell.x);
    if (-obstacles.find(index) > near) grid.getRow(cell.y)[cell.x] = cell_value(kHitEvidence);
  }
  const ObstacleField with_new(grid);
  for (const NewObstacle& cell : new_obstacles) {
    const auto index = static_cast<std::size_t>(cell.y * width + cell.x);
    // The nearest obstacle is a new one.
    if (-obstacles.find(index) > -with_new.find(index))
      grid.getRow(cell.y)[cell.x] = cell_value(kHitEvidence);
  }
  return grid;
}

}  // namespace

MovingThings::MovingThings(COccupancyGridMap2D& grid, const std::vector<NewObstacle>& new_obstacles,
                           const GridLayout& layout, const GridMapOptions& options)
    : layout_(layout),
      maker_(options),
      near_(static_cast<std::int64_t>(std::max(kNear_m / layout.resolution_m, kNearCells))),
      beams_(static_cast<float>(std::max(1.0, kBeamsPerMetre * layout.resolution_m))),
      share_of_near_(share_of_near(layout.resolution_m)),
      obstacles_(show_new_obstacles(new_obstacles, near_, grid)) {
  list_obstacles(grid);
  for (const NewObstacle& one : new_obstacles) {
    const std::int32_t found = obstacles_.find(static_cast<std::size_t>(one.y * layout_.width + one.x));
    if (found < 0) continue;
    cells_[static_cast<std::size_t>(found)].is_new = true;
    cells_[static_cast<std::size_t>(found)].of_all_scans = one.of_all_scans;
  }
  for (Sightings& cell : cells_) find_normal(cell);
}

template <class Visit>
void MovingThings::for_each_near(std::int64_t x, std::int64_t y, const Visit& visit) const {
  const double most = std::max(kNear_m / layout_.resolution_m, kNearCells);
  for_each_around(x, y, near_, [&](std::int32_t found) {
    const Sightings& cell = cells_[static_cast<std::size_t>(found)];
    const auto dx = static_cast<double>(cell.x - x);
    const auto dy = static_cast<double>(cell.y - y);
    if (dx * dx + dy * dy <= most * most) visit(found);
  });
}

void MovingThings::list_obstacles(const COccupancyGridMap2D& grid) {
  for (std::int64_t y = 0; y < layout_.height; ++y) {
    const auto* row = grid.getRow(static_cast<int>(y));
    for (std::int64_t x = 0; x < layout_.width; ++x) {
      if (row[x] >= 0) continue;
      cells_.emplace_back();
      cells_.back().x = static_cast<std::int32_t>(x);
      cells_.back().y = static_cast<std::int32_t>(y);
    }
  }
}

/// Finds the direction across the obstacles around a cell, if they form a line: the eigenvector of the
/// smaller eigenvalue of their covariance.
void MovingThings::find_normal(Sightings& cell) const {
  double n = 0;
  double x = 0;
  double y = 0;
  double xx = 0;
  double xy = 0;
  double yy = 0;
  for_each_around(cell.x, cell.y, cells_in(kStraightReach_m), [&](std::int32_t found) {
    const Sightings& other = cells_[static_cast<std::size_t>(found)];
    const double dx = other.x - cell.x;
    const double dy = other.y - cell.y;
    ++n;
    x += dx;
    y += dy;
    xx += dx * dx;
    xy += dx * dy;
    yy += dy * dy;
  });
  const double var_x = xx / n - x / n * (x / n);
  const double var_y = yy / n - y / n * (y / n);
  const double covariance = xy / n - x / n * (y / n);
  const double middle = (var_x + var_y) / 2;
  const double half = portable::hypot((var_x - var_y) / 2, covariance);
  if (!(half > 0) || middle - half > kStraightRatio * (middle + half)) return;
  const double along_rad = portable::atan2(2 * covariance, var_x - var_y) / 2;
  cell.normal_x = static_cast<float>(-portable::sin(along_rad));
  cell.normal_y = static_cast<float>(portable::cos(along_rad));
}

void MovingThings::add(const Frame& frame, const TPose2D& map_T_robot) {
  const double since_s = seconds(frame.time_us - interval_start_us_);
  const TPoint2D robot(map_T_robot.x, map_T_robot.y);
  if (interval_ == 0 || since_s < 0 || since_s >= kInterval_s ||
      distance_m(robot, interval_start_) >= kInterval_m) {
    end_interval();
    interval_start_us_ = frame.time_us;
    interval_start_ = robot;
    follow_path(robot);
  }
  const CellBox map{layout_.resolution_m, layout_.x_min, layout_.y_min, layout_.width, layout_.height};
  for (const Fan* fan : maker_.fans(frame, map_T_robot)) {
    mark_hits(*fan, map);
    mark_passes(*fan, map);
  }
}

/// Moves here_ on to the robot of this interval, once it is kPathStep_m away.
void MovingThings::follow_path(const TPoint2D& robot) {
  here_.time_us = interval_start_us_;
  const bool is_first = interval_ == 1;
  const double step_m = distance_m(robot, here_.robot);
  if (!is_first && step_m < kPathStep_m) return;
  here_.path_m += is_first ? 0 : step_m;
  here_.robot = robot;
}

/// Whether the robot is in another pass than then: it drove on and came back.
bool MovingThings::is_second_pass(const PathMark& since) const {
  return here_.path_m - since.path_m >= kPass_m && distance_m(here_.robot, since.robot) <= kPlace_m;
}

/// Notes that a beam ended on an obstacle that was known before, or crossed it.
void MovingThings::add_evidence(const Sightings* obstacle, double sign) {
  if (obstacle == nullptr) return;
  const auto x = static_cast<double>(obstacle->normal_x);
  const auto y = static_cast<double>(obstacle->normal_y);
  evidence_.push_back({obstacle->occupied_since.path_m, sign * x * x, sign * x * y, sign * y * y});
}

/// Sorts the evidence of this interval by the age of the obstacles and sums it up, the oldest first.
void MovingThings::sum_evidence() {
  std::stable_sort(evidence_.begin(), evidence_.end(),
                   [](const Evidence& a, const Evidence& b) { return a.since_m < b.since_m; });
  for (std::size_t i = 1; i < evidence_.size(); ++i) {
    evidence_[i].xx += evidence_[i - 1].xx;
    evidence_[i].xy += evidence_[i - 1].xy;
    evidence_[i].yy += evidence_[i - 1].yy;
  }
}

/// Marks the ends of the beams of a scan, surface by surface. A surface is a run of neighbouring beams that
/// end close to each other.
void MovingThings::mark_hits(const Fan& fan, const CellBox& map) {
  const std::vector<Ray>& rays = fan.rays;
  const double gap_rad = beam_gap_rad(fan);
  for (std::size_t begin = 0; begin < rays.size();) {
    std::size_t end = begin + 1;
    const auto goes_on = [&](std::size_t i) {
      const double spacing_m = gap_rad * distance_m(fan.start, rays[i].end);
      return rays[i].hit && distance_m(rays[i - 1].end, rays[i].end) <=
                                std::max(kSurfaceGap_m, kSurfaceSpacings * spacing_m);
    };
    while (rays[begin].hit && end < rays.size() && goes_on(end)) ++end;
    const bool is_large = distance_m(rays[begin].end, rays[end - 1].end) > kLargeSurface_m;
    for (; begin < end; ++begin)
      if (rays[begin].hit) mark_hit(map.in_cells(rays[begin].end), is_large);
  }
}

/// Marks the obstacle at the end of a beam, in cells, as hit, or the obstacles around it if there is none.
void MovingThings::mark_hit(const TPoint2D& end, bool of_surface) {
  const auto x = static_cast<std::int64_t>(end.x);
  const auto y = static_cast<std::int64_t>(end.y);
  const Sightings* oldest = nullptr;
  const auto mark = [&](std::int32_t found) {
    mark_seen(found);
    Sightings& cell = cells_[static_cast<std::size_t>(found)];
    oldest = older(oldest, cell);
    cell.hit_in = interval_;
    if (of_surface) cell.surface_in = interval_;
    return &cell;
  };
  const std::int32_t at_end = obstacles_.find(static_cast<std::size_t>(y * layout_.width + x));
  if (at_end >= 0) {
    Sightings& cell = *mark(at_end);
    if (cell.first_end == 0) cell.first_end = interval_;
    cell.last_end = interval_;
  } else if (-at_end <= near_)
    for_each_near(x, y, mark);
  add_evidence(oldest, 1);
}

/// Marks the obstacles that the beams of a scan crossed, if their neighbours crossed the space around, too: a
/// beam along a surface has a neighbour that ends on it. Leaps over space without obstacles.
void MovingThings::mark_passes(const Fan& fan, const CellBox& map) {
  const TPoint2D start = map.in_cells(fan.start);
  const double gap_rad = beam_gap_rad(fan);
  std::vector<double> clear_m;  // index: ray
  for (const Ray& ray : fan.rays)
    clear_m.push_back(ray.returned ? distance_m(fan.start, ray.end) - kBeyond_m
                                   : std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < fan.rays.size(); ++i) {
    const Ray& ray = fan.rays[i];
    const double length_m = distance_m(fan.start, ray.end);
    const double free_m = std::min(length_m - kBeyond_m, kMostRange_m);
    if (!ray.returned || free_m <= 0) continue;
    const TPoint2D along = (ray.end - fan.start) * (1 / length_m);
    const TPoint2D end = map.in_cells(fan.start + along * free_m);
    const Sightings* oldest = nullptr;
    leap_line(digital_line(start, end, layout_.width), [&](std::int64_t index) {
      const std::int32_t found = obstacles_.find(static_cast<std::size_t>(index));
      if (found < 0) return std::int64_t{-found};
      const Sightings& cell = cells_[static_cast<std::size_t>(found)];
      const double range_m =
          ((cell.x + 0.5 - start.x) * along.x + (cell.y + 0.5 - start.y) * along.y) * layout_.resolution_m;
      double sine = 1;  // of the angle at which the beam crosses the obstacle
      if (cell.normal_x != 0 || cell.normal_y != 0) {
        sine = std::abs(static_cast<double>(cell.normal_x) * along.x +
                        static_cast<double>(cell.normal_y) * along.y);
        if (std::min(range_m, length_m - range_m) * sine < kAside_m) return std::int64_t{1};
      }
      if (range_m * gap_rad > kWidestGap_m * sine || is_narrow(clear_m, i, range_m, gap_rad))
        return std::int64_t{1};
      if (cell.hit_in != interval_) oldest = older(oldest, cell);
      mark_pass(found, static_cast<float>(range_m > kFullRange_m ? kFullRange_m / range_m : 1));
      return std::int64_t{1};
    });
    add_evidence(oldest, -1);
  }
}

void MovingThings::mark_pass(std::int32_t found, float weight) {
  mark_seen(found);
  Sightings& cell = cells_[static_cast<std::size_t>(found)];
  if (cell.passed_in != interval_) cell.beams = 0;
  cell.passed_in = interval_;
  cell.beams += weight;
}

/// Notes that this interval saw a cell. Call before the mark of the first sighting.
void MovingThings::mark_seen(std::int32_t found) {
  const Sightings& cell = cells_[static_cast<std::size_t>(found)];
  if (cell.passed_in != interval_ && cell.hit_in != interval_)
    seen_.push_back(static_cast<std::uint32_t>(found));
}

void MovingThings::end_interval() {
  sum_evidence();
  for (const std::uint32_t index : seen_) {
    Sightings& cell = cells_[index];
    const bool is_new_visit = cell.seen_in == 0 || interval_ - cell.seen_in > kGapOfVisits;
    cell.seen_in = interval_;
    if (is_new_visit) cell.free_of_visit = 0;
    see_crossed(cell);
    if (is_hit_near(cell))
      see_occupied(cell, is_new_visit);
    else
      see_free(cell);
  }
  seen_.clear();
  evidence_.clear();
  ++interval_;
}

/// Whether, of the obstacles that were known before this part of the path, this interval saw more than it
/// crossed, in each direction that they face. At wrong poses it would cross those that face the error.
bool MovingThings::agrees_with_obstacles_before(double path_m) const {
  const auto after =
      std::upper_bound(evidence_.begin(), evidence_.end(), path_m,
                       [](double limit_m, const Evidence& evidence) { return limit_m < evidence.since_m; });
  if (after == evidence_.begin()) return false;
  const Evidence& sum = *std::prev(after);
  const double smaller = (sum.xx + sum.yy) / 2 - portable::hypot((sum.xx - sum.yy) / 2, sum.xy);
  return smaller > kLeastBeams;  // the smaller eigenvalue
}

/// Counts the beams that crossed a cell before the first beam and after the last beam that ended in the cell
/// itself.
void MovingThings::see_crossed(Sightings& cell) const {
  if (cell.last_end == interval_)
    cell.crossed_after = 0;
  else if (cell.passed_in == interval_)
    (cell.first_end == 0 ? cell.crossed_before : cell.crossed_after) += std::min(1.0F, cell.beams / beams_);
}

/// Returns whether a beam of this interval ended in a cell or near it.
bool MovingThings::is_hit_near(const Sightings& cell) const {
  if (cell.hit_in == interval_) return true;
  bool is_near = false;
  for_each_near(cell.x, cell.y, [&](std::int32_t found) {
    is_near = is_near || cells_[static_cast<std::size_t>(found)].hit_in == interval_;
  });
  return is_near;
}

void MovingThings::see_occupied(Sightings& cell, bool is_new_visit) {
  if (cell.hits == kMostCount) return;
  const bool returns = cell.hits > 0 && cell.free_since_hit >= kReturn;
  if (cell.hits == 0) cell.first_hit = interval_;
  if (cell.hits == 0 || returns) {
    cell.occupied_since = here_;
    cell.stays = false;
  }
  if (is_new_visit || cell.hits == 0 || interval_ - cell.last_hit > kGapOfVisits) ++cell.visits;
  if (returns)
    ++cell.returns;
  else if (cell.hits > 0)
    cell.free -= cell.free_since_hit;
  cell.last_hit = interval_;
  cell.hit_m = here_.path_m;
  cell.free_of_visit = 0;
  cell.free_since_hit = 0;
  cell.free_of_pass = 0;
  cell.returned_after = std::max(cell.returned_after, cell.free_passes);
  cell.free_passes = 0;
  ++cell.hits;
  if (cell.surface_in == interval_) ++cell.surface;
  cell.stays = cell.stays || (is_second_pass(cell.occupied_since) &&
                              seconds(here_.time_us - cell.occupied_since.time_us) >= kStay_s);
}

/// Counts the beams that crossed a cell or, as they would have hit the same thing, the obstacles within the
/// tolerance of a hit. A beam counts once for each of these obstacles, so a large thing needs fewer beams.
void MovingThings::see_free(Sightings& cell) {
  float around = 0;
  for_each_near(cell.x, cell.y, [&](std::int32_t found) {
    const Sightings& other = cells_[static_cast<std::size_t>(found)];
    if (other.passed_in == interval_) around += other.beams;
  });
  const float beams = std::max(cell.beams, share_of_near_ * around);
  const float seen = std::min(1.0F, beams / beams_);
  const float weight = std::min(seen, kMostOfVisit - cell.free_of_visit);
  if (agrees_with_obstacles_before(cell.hit_m - kPlace_m)) {
    if (cell.free_of_pass <= 0 || is_second_pass(cell.free_since)) {
      cell.free_since = here_;
      cell.free_of_pass = 0;
    }
    const bool is_counted = cell.free_of_pass >= 1;
    cell.free_of_pass += seen;
    if (!is_counted && cell.free_of_pass >= 1 && cell.free_passes < kMostCount) ++cell.free_passes;
  }
  cell.free += weight;
  cell.free_of_visit += weight;
  cell.free_since_hit += weight;
}

}  // namespace psi_slam
