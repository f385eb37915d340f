// SPDX-License-Identifier: BSD-3-Clause
#include "rendering/moving_things.h"

#include <algorithm>
#include <cmath>

#include "rendering/digital_line.h"

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;
using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

/// Sets all negative numbers to minus the distance to the nearest number that is not negative: the number of
/// king's moves, at most `most`.
void measure_distances(std::vector<std::int32_t>& cells, std::int64_t width, std::int64_t height,
                       std::int32_t most) {
  const auto update = [&](std::int64_t x, std::int64_t y, std::int64_t step) {
    std::int32_t& cell = cells[static_cast<std::size_t>(y * width + x)];
    if (cell >= 0) return;
    std::int32_t nearest = -cell;
    const auto look = [&](std::int64_t at_x, std::int64_t at_y) {
      if (at_x < 0 || at_x >= width || at_y < 0 || at_y >= height) return;
      nearest = std::min(nearest, 1 - std::min(0, cells[static_cast<std::size_t>(at_y * width + at_x)]));
    };
    look(x - step, y);
    for (std::int64_t at_x = x - 1; at_x <= x + 1; ++at_x) look(at_x, y - step);
    cell = -nearest;
  };
  for (std::int32_t& cell : cells) cell = cell < 0 ? -most : cell;
  for (std::int64_t y = 0; y < height; ++y)
    for (std::int64_t x = 0; x < width; ++x) update(x, y, 1);
  for (std::int64_t y = height - 1; y >= 0; --y)
    for (std::int64_t x = width - 1; x >= 0; --x) update(x, y, -1);
}

}  // namespace

MovingThings::MovingThings(const COccupancyGridMap2D& grid, const GridLayout& layout,
                           const GridMapOptions& options, const MovingThingsOptions& moving)
    : layout_(layout),
      options_(moving),
      maker_(options),
      reach_(static_cast<std::int64_t>(std::ceil(moving.near_m / layout.resolution_m - 1e-9))),
      find_(static_cast<std::size_t>(layout.width * layout.height), -1) {
  constexpr std::int32_t kFar = 10'000;
  for (std::int64_t y = 0; y < layout.height; ++y) {
    const auto* row = grid.getRow(static_cast<int>(y));
    for (std::int64_t x = 0; x < layout.width; ++x) {
      if (row[x] >= 0) continue;
      const std::int64_t index = y * layout.width + x;
      find_[static_cast<std::size_t>(index)] = static_cast<std::int32_t>(cells_.size());
      cells_.emplace_back();
      cells_.back().index = index;
    }
  }
  measure_distances(find_, layout.width, layout.height, kFar);
}

void MovingThings::add(const Frame& frame, const TPose2D& map_T_robot) {
  const double since_s = seconds(frame.time_us - interval_start_us_);
  if (!any_ || since_s < 0 || since_s >= options_.interval_s) {
    end_interval();
    interval_start_us_ = frame.time_us;
    any_ = true;
  }
  const CellBox map{layout_.resolution_m, layout_.x_min, layout_.y_min, layout_.width, layout_.height};
  for (const Fan* fan : maker_.fans(frame, map_T_robot)) {
    const TPoint2D start = map.in_cells(fan->start);
    for (const Ray& ray : fan->rays) {
      const TPoint2D end = map.in_cells(ray.end);
      if (ray.hit) mark_hit(end);
      if (!ray.returned) continue;
      const TPoint2D way = end - start;
      const double length_m = std::hypot(way.x, way.y) * layout_.resolution_m;
      const double free_m = std::min(length_m - options_.beyond_m, options_.max_range_m);
      if (free_m <= 0) continue;
      leap_line(start, start + way * (free_m / length_m), layout_.width, [&](std::int64_t index) {
        const std::int32_t found = find_[static_cast<std::size_t>(index)];
        if (found < 0) return std::int64_t{-found};
        Sightings& cell = cells_[static_cast<std::size_t>(found)];
        if (cell.passed_in != interval_ && cell.hit_in != interval_)
          seen_.push_back(static_cast<std::uint32_t>(found));
        cell.passed_in = interval_;
        return std::int64_t{1};
      });
    }
  }
}

/// Marks the occupied cells around the end of a beam, in cells, as hit.
void MovingThings::mark_hit(const TPoint2D& end) {
  const auto x = static_cast<std::int64_t>(end.x);
  const auto y = static_cast<std::int64_t>(end.y);
  if (-find_[static_cast<std::size_t>(y * layout_.width + x)] > reach_) return;
  for (std::int64_t at_y = std::max<std::int64_t>(y - reach_, 0);
       at_y <= std::min(y + reach_, layout_.height - 1); ++at_y)
    for (std::int64_t at_x = std::max<std::int64_t>(x - reach_, 0);
         at_x <= std::min(x + reach_, layout_.width - 1); ++at_x) {
      const std::int32_t found = find_[static_cast<std::size_t>(at_y * layout_.width + at_x)];
      if (found < 0) continue;
      Sightings& cell = cells_[static_cast<std::size_t>(found)];
      if (cell.passed_in != interval_ && cell.hit_in != interval_)
        seen_.push_back(static_cast<std::uint32_t>(found));
      cell.hit_in = interval_;
    }
}

void MovingThings::end_interval() {
  for (const std::uint32_t index : seen_) see(cells_[index], cells_[index].hit_in != interval_);
  seen_.clear();
  ++interval_;
}

void MovingThings::see(Sightings& cell, bool is_free) {
  const bool goes_on = (cell.run < 0) == is_free && interval_ - cell.seen_in <= options_.gap;
  if (!goes_on) cell.run = 0;
  cell.seen_in = interval_;
  if (std::abs(cell.run) == options_.most_of_run) return;
  cell.run = static_cast<std::int16_t>(cell.run + (is_free ? -1 : 1));
  ++(is_free ? cell.free : cell.occupied);
}

bool MovingThings::is_moving(const Sightings& cell) const {
  const std::int64_t x = cell.index % layout_.width;
  const std::int64_t y = cell.index / layout_.width;
  double free = 0;
  double occupied = 0;
  double count = 0;
  for (std::int64_t at_y = std::max<std::int64_t>(y - options_.patch, 0);
       at_y <= std::min(y + options_.patch, layout_.height - 1); ++at_y)
    for (std::int64_t at_x = std::max<std::int64_t>(x - options_.patch, 0);
         at_x <= std::min(x + options_.patch, layout_.width - 1); ++at_x) {
      const std::int32_t found = find_[static_cast<std::size_t>(at_y * layout_.width + at_x)];
      if (found < 0) continue;
      free += cells_[static_cast<std::size_t>(found)].free;
      occupied += cells_[static_cast<std::size_t>(found)].occupied;
      ++count;
    }
  return free >= options_.least * count && free >= options_.share * (free + occupied);
}

void MovingThings::remove_from(COccupancyGridMap2D& grid) {
  end_interval();
  for (const Sightings& cell : cells_)
    if (is_moving(cell))
      grid.getRow(static_cast<int>(cell.index / layout_.width))[cell.index % layout_.width] =
          cell_value(kPassEvidence);
}

}  // namespace psi_slam
