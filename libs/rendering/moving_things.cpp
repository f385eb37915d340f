// SPDX-License-Identifier: BSD-3-Clause
#include "rendering/moving_things.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "base/portable_math.h"
#include "frames/pose_operations.h"

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
constexpr double kLeastFree = 1;       // weight that refutes a cell of a single visit
constexpr double kFreePerVisit = 0.7;  // and for each further visit
constexpr double kFreePerReturn = 1;
constexpr double kFreeOfSurface =
    3;  // share by which these grow for a cell that is always part of a large surface
constexpr double kPatch_m = 0.25;         // reach of the cells that are judged together
constexpr double kMostRefuted = 1.5;      // by which one cell counts in its patch
constexpr double kLeastOfPatch = 0.4;     // mean refutation around a cell that is refuted itself
constexpr double kStraightReach_m = 0.3;  // reach of the cells whose line gives the normal
constexpr double kStraightRatio = 0.1;    // of the variances across and along a straight obstacle
constexpr double kRim_m = 0.15;           // reach of the cells that vanish with a thing
constexpr double kLeastOfRim = 0.3;       // refutation of a cell that vanishes with a thing
constexpr float kLeastCrossed = 1;        // or weight of the beams that crossed it without an end in it
constexpr std::uint32_t kRimSlack = 3;    // intervals by which it may have been seen longer
constexpr double kShareOfThing =
    0.35;  // or share of the obstacles around it that vanish and were hit as long
constexpr double kSurfaceGap_m = 0.25;     // largest distance between the ends of neighbouring beams
constexpr double kSurfaceSpacings = 4;     // or multiple of the distance between the beams there
constexpr std::int64_t kSurfaceShare = 8;  // one in so many hits makes a long thing a surface
constexpr double kLargeSurface_m = 1.5;
constexpr double kLink_m = 0.3;  // gap within one thing
constexpr std::uint16_t kMostCount = 60'000;

std::int64_t cells_in(double length_m, double resolution_m) {
  return static_cast<std::int64_t>(std::ceil(length_m / resolution_m - 1e-9));
}

/// Returns whether [first, last] lies within [other_first, other_last], with kRimSlack intervals more.
bool is_within(std::uint32_t first, std::uint32_t last, std::uint32_t other_first, std::uint32_t other_last) {
  return first + kRimSlack >= other_first && last <= other_last + kRimSlack;
}

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

}  // namespace

MovingThings::MovingThings(const COccupancyGridMap2D& grid, const GridLayout& layout,
                           const GridMapOptions& options)
    : layout_(layout),
      maker_(options),
      near_(static_cast<std::int64_t>(std::max(kNear_m / layout.resolution_m, kNearCells))),
      beams_(static_cast<float>(std::max(1.0, kBeamsPerMetre * layout.resolution_m))),
      share_of_near_(share_of_near(layout.resolution_m)),
      obstacles_(grid) {
  list_obstacles(grid);
  for (Sightings& cell : cells_) find_normal(cell);
}

template <class Visit>
void MovingThings::for_each_around(std::int64_t x, std::int64_t y, std::int64_t reach,
                                   const Visit& visit) const {
  const std::int64_t y_end = std::min(y + reach, layout_.height - 1);
  const std::int64_t x_end = std::min(x + reach, layout_.width - 1);
  for (std::int64_t at_y = std::max<std::int64_t>(y - reach, 0); at_y <= y_end; ++at_y)
    for (std::int64_t at_x = std::max<std::int64_t>(x - reach, 0); at_x <= x_end; ++at_x) {
      const std::int32_t found = obstacles_.find(static_cast<std::size_t>(at_y * layout_.width + at_x));
      if (found >= 0) visit(found);
    }
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
  for_each_around(cell.x, cell.y, cells_in(kStraightReach_m, layout_.resolution_m), [&](std::int32_t found) {
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
  }
  const CellBox map{layout_.resolution_m, layout_.x_min, layout_.y_min, layout_.width, layout_.height};
  for (const Fan* fan : maker_.fans(frame, map_T_robot)) {
    mark_hits(*fan, map);
    mark_passes(*fan, map);
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
  const auto mark = [&](std::int32_t found) {
    mark_seen(found);
    Sightings& cell = cells_[static_cast<std::size_t>(found)];
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
      mark_pass(found, static_cast<float>(range_m > kFullRange_m ? kFullRange_m / range_m : 1));
      return std::int64_t{1};
    });
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
  ++interval_;
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
  if (cell.hits == 0) cell.first_hit = interval_;
  if (is_new_visit || cell.hits == 0 || interval_ - cell.last_hit > kGapOfVisits) ++cell.visits;
  if (cell.hits > 0 && cell.free_since_hit >= kReturn)
    ++cell.returns;
  else if (cell.hits > 0)
    cell.free -= cell.free_since_hit;
  cell.last_hit = interval_;
  cell.free_of_visit = 0;
  cell.free_since_hit = 0;
  ++cell.hits;
  if (cell.surface_in == interval_) ++cell.surface;
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
  const float weight = std::min(std::min(1.0F, beams / beams_), kMostOfVisit - cell.free_of_visit);
  cell.free += weight;
  cell.free_of_visit += weight;
  cell.free_since_hit += weight;
}

/// Returns the share of the free weight that refutes a cell, at most kMostRefuted.
double MovingThings::refuted(const Sightings& cell) {
  const double surface = static_cast<double>(cell.surface) / std::max<double>(1, cell.hits);
  const double needed = kLeastFree + kFreePerVisit * (cell.visits - 1) + kFreePerReturn * cell.returns;
  return std::min(kMostRefuted, static_cast<double>(cell.free) / (needed * (1 + kFreeOfSurface * surface)));
}

/// Judges a cell together with the obstacles around it that were seen occupied from before its first hit
/// until after its last.
bool MovingThings::is_moving(const Sightings& cell) const {
  if (cell.hits == 0) return false;
  double sum = 0;
  int count = 0;
  for_each_around(cell.x, cell.y, cells_in(kPatch_m, layout_.resolution_m), [&](std::int32_t found) {
    const Sightings& other = cells_[static_cast<std::size_t>(found)];
    if (other.hits == 0 || other.first_hit > cell.first_hit || other.last_hit < cell.last_hit) return;
    sum += refuted(other);
    ++count;
  });
  return sum >= count || (refuted(cell) >= 1 && sum >= kLeastOfPatch * count);
}

/// Finds the connected parts of the cells that count as moving. Resets those parts that are longer than a
/// person, a cart or a door and that beams hit as a large surface in an eighth of the intervals.
void MovingThings::keep_large_surfaces(std::vector<bool>& is_moving) const {
  const std::int64_t link = cells_in(kLink_m, layout_.resolution_m);
  std::vector<bool> is_found(cells_.size());
  for (std::size_t first = 0; first < cells_.size(); ++first) {
    if (!is_moving[first] || is_found[first]) continue;
    is_found[first] = true;
    std::vector<std::size_t> part{first};
    std::int64_t surface = 0;
    std::int64_t hits = 0;
    Sightings low = cells_[first];
    Sightings high = low;
    for (std::size_t i = 0; i < part.size(); ++i) {
      const Sightings& cell = cells_[part[i]];
      surface += cell.surface;
      hits += cell.hits;
      low.x = std::min(low.x, cell.x);
      low.y = std::min(low.y, cell.y);
      high.x = std::max(high.x, cell.x);
      high.y = std::max(high.y, cell.y);
      for_each_around(cell.x, cell.y, link, [&](std::int32_t found) {
        const auto next = static_cast<std::size_t>(found);
        if (!is_moving[next] || is_found[next]) return;
        is_found[next] = true;
        part.push_back(next);
      });
    }
    const double length_m = layout_.resolution_m * portable::hypot(static_cast<double>(high.x - low.x + 1),
                                                                   static_cast<double>(high.y - low.y + 1));
    if (length_m <= kLargeSurface_m || kSurfaceShare * surface <= hits) continue;
    for (const std::size_t cell : part) is_moving[cell] = false;
  }
}

/// Adds the cells at the rim of moving things, which few beams refute or which are close to a wall: beams saw
/// them occupied only while they saw a neighbour that moved. Adds the rest of a thing, too: cells
/// around which enough obstacles moved.
void MovingThings::add_rims(std::vector<bool>& is_moving) const {
  const std::int64_t reach = cells_in(kRim_m, layout_.resolution_m);
  const std::int64_t patch = cells_in(kPatch_m, layout_.resolution_m);
  std::vector<std::size_t> rim;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const Sightings& cell = cells_[i];
    if (is_moving[i] || cell.hits == 0) continue;
    const bool is_doubtful = refuted(cell) >= kLeastOfRim;
    const bool is_crossed = cell.first_end != 0 && cell.crossed_before + cell.crossed_after >= kLeastCrossed;
    const auto hit_with = [&](const Sightings& thing) {
      return is_within(cell.first_hit, cell.last_hit, thing.first_hit, thing.last_hit);
    };
    const auto ended_with = [&](const Sightings& thing) {
      return cell.first_end != 0 && thing.first_end != 0 &&
             is_within(cell.first_end, cell.last_end, thing.first_end, thing.last_end);
    };
    bool is_of_thing = false;
    if (is_doubtful || is_crossed)
      for_each_around(cell.x, cell.y, reach, [&](std::int32_t found) {
        const Sightings& thing = cells_[static_cast<std::size_t>(found)];
        is_of_thing =
            is_of_thing || (is_moving[static_cast<std::size_t>(found)] &&
                            ((is_doubtful && hit_with(thing)) || (is_crossed && ended_with(thing))));
      });
    if (!is_of_thing && cell.first_end != 0) {
      int around = 0;
      int moving = 0;
      for_each_around(cell.x, cell.y, patch, [&](std::int32_t found) {
        const auto other = static_cast<std::size_t>(found);
        ++around;
        if (is_moving[other] && ended_with(cells_[other])) ++moving;
      });
      is_of_thing = moving >= kShareOfThing * around;
    }
    if (is_of_thing) rim.push_back(i);
  }
  for (const std::size_t i : rim) is_moving[i] = true;
}

void MovingThings::remove_from(COccupancyGridMap2D& grid) {
  end_interval();
  std::vector<bool> is_moving(cells_.size());
  for (std::size_t i = 0; i < cells_.size(); ++i) is_moving[i] = this->is_moving(cells_[i]);
  keep_large_surfaces(is_moving);
  add_rims(is_moving);
  for (std::size_t i = 0; i < cells_.size(); ++i)
    if (is_moving[i]) grid.getRow(cells_[i].y)[cells_[i].x] = cell_value(kPassEvidence);
}

}  // namespace psi_slam
