// SPDX-License-Identifier: BSD-3-Clause
// Judges which obstacles of the map moved, after all frames.
#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/portable_math.h"
#include "rendering/moving_things.h"

namespace psi_slam {
namespace {

constexpr double kLeastFree = 1;       // weight that refutes a cell of a single visit
constexpr double kFreePerVisit = 0.7;  // and for each further visit
constexpr double kFreePerReturn = 1;
constexpr double kFreeOfSurface = 3;    // share by which these grow for a cell of a large surface
constexpr double kPatch_m = 0.25;       // reach of the cells that are judged together
constexpr double kMostRefuted = 1.5;    // by which one cell counts in its patch
constexpr double kLeastOfPatch = 0.4;   // mean refutation around a cell that is refuted itself
constexpr double kRim_m = 0.15;         // reach of the cells that vanish with a thing
constexpr double kLeastOfRim = 0.3;     // refutation of a cell that vanishes with a thing
constexpr float kLeastCrossed = 1;      // or weight of the beams that crossed it without an end in it
constexpr std::uint32_t kRimSlack = 3;  // intervals by which it may have been seen longer
constexpr double kShareOfThing = 0.35;  // or share of the obstacles around that vanish and were hit as long
constexpr std::int64_t kSurfaceShare = 8;  // one in so many hits makes a long thing a surface
constexpr double kLink_m = 0.3;            // gap within one thing

/// Returns whether [first, last] lies within [other_first, other_last], with kRimSlack intervals more.
bool is_within(std::uint32_t first, std::uint32_t last, std::uint32_t other_first, std::uint32_t other_last) {
  return first + kRimSlack >= other_first && last <= other_last + kRimSlack;
}

}  // namespace

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
  for_each_around(cell.x, cell.y, cells_in(kPatch_m), [&](std::int32_t found) {
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
  const std::int64_t link = cells_in(kLink_m);
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
  const std::int64_t reach = cells_in(kRim_m);
  const std::int64_t patch = cells_in(kPatch_m);
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

void MovingThings::remove_from(mrpt::maps::COccupancyGridMap2D& grid) {
  end_interval();
  std::vector<bool> is_moving(cells_.size());
  for (std::size_t i = 0; i < cells_.size(); ++i) is_moving[i] = this->is_moving(cells_[i]);
  keep_large_surfaces(is_moving);
  add_rims(is_moving);
  for (std::size_t i = 0; i < cells_.size(); ++i)
    if (is_moving[i]) grid.getRow(cells_[i].y)[cells_[i].x] = cell_value(kPassEvidence);
}

}  // namespace psi_slam
