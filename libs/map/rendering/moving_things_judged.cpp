// SPDX-License-Identifier: BSD-3-Clause
// Judges which obstacles of the map moved, after all frames.
#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "base/portable_math.h"
#include "map/rendering/moving_things.h"

namespace psi_slam {
namespace {

constexpr double kLeastFree = 1;       // weight that refutes a cell of a single visit
constexpr double kFreePerVisit = 0.7;  // and for each further visit
constexpr double kFreePerReturn = 1;
constexpr double kFreePasses = 2;       // after the last hit
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
double MovingThings::refuted(const Sightings& cell, float free) {
  const double surface = static_cast<double>(cell.surface) / std::max<double>(1, cell.hits);
  const double needed = kLeastFree + kFreePerVisit * (cell.visits - 1) + kFreePerReturn * cell.returns;
  return std::min(kMostRefuted, static_cast<double>(free) / (needed * (1 + kFreeOfSurface * surface)));
}

/// Returns by how much the passes that saw a cell free after the last hit show that it is free, at most
/// kMostRefuted. They must be more than those after which it was seen occupied again: glass and thin things.
double MovingThings::gone(const Sightings& cell) {
  return std::min(kMostRefuted, cell.free_passes / std::max(kFreePasses, cell.returned_after + 1.0));
}

/// Judges a cell together with the obstacles around it that were seen occupied from before its first hit
/// until after its last. `refuted(cell)` is the refutation that counts.
template <class Refuted>
bool MovingThings::is_refuted(const Sightings& cell, const Refuted& refuted) const {
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

/// Returns what becomes of each cell. A cell that was seen free is gone if what was seen after the last hit
/// refutes it. Otherwise it is doubtful, unless two passes saw enough of the obstacles around it occupied.
std::vector<MovingThings::Fate> MovingThings::fates() const {
  std::vector<Fate> fates(cells_.size(), Fate::kStays);
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const auto at_any_time = [](const Sightings& cell) {
      return std::max(refuted(cell, cell.free), gone(cell));
    };
    const auto afterwards = [](const Sightings& cell) {
      return std::max(refuted(cell, cell.free_since_hit), gone(cell));
    };
    if (!is_refuted(cells_[i], at_any_time)) continue;
    const bool is_gone = is_refuted(cells_[i], afterwards);
    fates[i] = is_gone ? Fate::kGone : Fate::kDoubtful;
  }
  keep_confirmed(fates);
  keep_large_surfaces(fates);
  add_rims(fates);
  return fates;
}

/// Confirms the doubtful cells around which two passes saw enough of the other doubtful cells occupied.
void MovingThings::keep_confirmed(std::vector<Fate>& fates) const {
  std::vector<std::size_t> confirmed;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    if (fates[i] != Fate::kDoubtful) continue;
    int around = 0;
    int staying = 0;
    for_each_around(cells_[i].x, cells_[i].y, cells_in(kPatch_m), [&](std::int32_t found) {
      const auto other = static_cast<std::size_t>(found);
      if (fates[other] != Fate::kDoubtful) return;
      ++around;
      staying += cells_[other].stays ? 1 : 0;
    });
    if (staying >= kShareOfThing * around) confirmed.push_back(i);
  }
  for (const std::size_t i : confirmed) fates[i] = Fate::kConfirmed;
}

/// Whether most cells of a large surface were seen free by two passes that agree with older obstacles.
bool MovingThings::is_changed_surface(const std::vector<std::size_t>& part) const {
  const auto changed =
      std::count_if(part.begin(), part.end(), [&](std::size_t i) { return gone(cells_[i]) >= 1; });
  return 2 * static_cast<std::size_t>(changed) > part.size();
}

/// Finds the connected parts of the cells that count as moving. Keeps those parts that are longer than a
/// person, a cart or a door and that beams hit as a large surface in an eighth of the intervals, unless the
/// building changed.
void MovingThings::keep_large_surfaces(std::vector<Fate>& fates) const {
  const std::int64_t link = cells_in(kLink_m);
  std::vector<bool> is_found(cells_.size());
  for (std::size_t first = 0; first < cells_.size(); ++first) {
    if (!vanishes(fates[first]) || is_found[first]) continue;
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
        if (!vanishes(fates[next]) || is_found[next]) return;
        is_found[next] = true;
        part.push_back(next);
      });
    }
    const double length_m = layout_.resolution_m * portable::hypot(static_cast<double>(high.x - low.x + 1),
                                                                   static_cast<double>(high.y - low.y + 1));
    if (length_m <= kLargeSurface_m || kSurfaceShare * surface <= hits || is_changed_surface(part)) continue;
    for (const std::size_t cell : part)
      if (!cells_[cell].is_new) fates[cell] = Fate::kStays;
  }
}

/// Adds the cells at the rim of moving things, which few beams refute or which are close to a wall: beams saw
/// them occupied only while they saw a neighbour that moved. Adds the rest of a thing, too: cells
/// around which enough obstacles moved.
void MovingThings::add_rims(std::vector<Fate>& fates) const {
  const std::int64_t reach = cells_in(kRim_m);
  const std::int64_t patch = cells_in(kPatch_m);
  std::vector<std::pair<std::size_t, Fate>> rim;
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const Sightings& cell = cells_[i];
    if (fates[i] != Fate::kStays || cell.hits == 0) continue;
    const bool is_doubtful = refuted(cell, cell.free) >= kLeastOfRim;
    const bool is_crossed = cell.first_end != 0 && cell.crossed_before + cell.crossed_after >= kLeastCrossed;
    const auto hit_with = [&](const Sightings& thing) {
      return is_within(cell.first_hit, cell.last_hit, thing.first_hit, thing.last_hit);
    };
    const auto ended_with = [&](const Sightings& thing) {
      return cell.first_end != 0 && thing.first_end != 0 &&
             is_within(cell.first_end, cell.last_end, thing.first_end, thing.last_end);
    };
    bool is_of_thing = false;
    bool is_gone = false;
    if (is_doubtful || is_crossed)
      for_each_around(cell.x, cell.y, reach, [&](std::int32_t found) {
        const Sightings& thing = cells_[static_cast<std::size_t>(found)];
        const Fate fate = fates[static_cast<std::size_t>(found)];
        if (!vanishes(fate) || !((is_doubtful && hit_with(thing)) || (is_crossed && ended_with(thing))))
          return;
        is_of_thing = true;
        is_gone = is_gone || fate == Fate::kGone;
      });
    if (!is_of_thing && cell.first_end != 0) {
      int around = 0;
      int moving = 0;
      for_each_around(cell.x, cell.y, patch, [&](std::int32_t found) {
        const auto other = static_cast<std::size_t>(found);
        ++around;
        if (!vanishes(fates[other]) || !ended_with(cells_[other])) return;
        ++moving;
        is_gone = is_gone || fates[other] == Fate::kGone;
      });
      is_of_thing = moving >= kShareOfThing * around;
    }
    if (is_of_thing) rim.emplace_back(i, is_gone ? Fate::kGone : Fate::kDoubtful);
  }
  for (const auto& [i, fate] : rim) fates[i] = fate;
}

void MovingThings::update(mrpt::maps::COccupancyGridMap2D& grid) {
  end_interval();
  const std::vector<Fate> fates = this->fates();
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    auto& value = grid.getRow(cells_[i].y)[cells_[i].x];
    if (fates[i] == Fate::kGone)
      value = cell_value(kPassEvidence);
    else if (fates[i] == Fate::kDoubtful)
      value = cell_value(0);
    else if (cells_[i].is_new && cells_[i].hits == 0)
      value = cells_[i].of_all_scans;
    else if (cells_[i].is_new && fates[i] == Fate::kStays && !cells_[i].stays)
      value = cell_value(0);
  }
}

}  // namespace psi_slam
