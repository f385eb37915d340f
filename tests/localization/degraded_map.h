// SPDX-License-Identifier: BSD-3-Clause
// Grid maps as other programs draw them from other recordings: cells are occupied, free or unknown, walls are
// thick, ragged and slightly displaced, free space has specks, and furniture was moved.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/random_draws.h"

namespace psi_slam {

struct MapFaults {
  int displaced_cells = 0;      ///< walls in each patch of 2 m are displaced by up to this along x and y
  int thickened_cells = 0;      ///< walls grow by this on all sides
  double ragged_share = 0;      ///< share of the cells beside walls that are occupied too
  double speck_share = 0;       ///< share of free cells that are occupied
  double furniture_per_m2 = 0;  ///< boxes of 0.4 m to 0.8 m per free square metre that the scans do not see
  int merged_cells = 1;         ///< side length of the resulting cells, in cells of the map
};

/// Draws a map with faults. The same map, faults and seed give the same cells.
class DegradedMap {
 public:
  using Grid = mrpt::maps::COccupancyGridMap2D;

  DegradedMap(const Grid& map, const MapFaults& faults, std::uint64_t seed)
      : map_(map),
        width_(static_cast<int>(map.getSizeX())),
        height_(static_cast<int>(map.getSizeY())),
        draws_(seed, "degraded map", 0) {
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) cells_.push_back(state_of(map.getCell(x, y)));
    if (faults.displaced_cells > 0) displace(faults.displaced_cells);
    if (faults.thickened_cells > 0) thicken(faults.thickened_cells, 1);
    if (faults.ragged_share > 0) thicken(1, faults.ragged_share);
    add_specks(faults.speck_share);
    add_furniture(faults.furniture_per_m2);
    merged_ = std::max(1, faults.merged_cells);
  }

  Grid grid() const {
    const int width = width_ / merged_;
    const int height = height_ / merged_;
    const float resolution_m = map_.getResolution() * static_cast<float>(merged_);
    Grid grid;
    grid.setSize(map_.getXMin(), map_.getXMin() + static_cast<float>(width) * resolution_m, map_.getYMin(),
                 map_.getYMin() + static_cast<float>(height) * resolution_m, resolution_m, 0.5F);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) grid.setCell(x, y, merged_cell(x, y));
    return grid;
  }

 private:
  enum class State : std::uint8_t { kOccupied, kFree, kUnknown };

  static State state_of(float free_probability) {
    if (free_probability < 0.35F) return State::kOccupied;
    return free_probability > 0.6F ? State::kFree : State::kUnknown;
  }

  bool inside(int x, int y) const { return x >= 0 && y >= 0 && x < width_ && y < height_; }
  State& at(std::vector<State>& cells, int x, int y) const {
    return cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                 static_cast<std::size_t>(x)];
  }

  /// Calls visit(x, y) for each occupied cell of the map as it is now.
  template <class Visit>
  void for_each_wall(const Visit& visit) {
    std::vector<State> now = cells_;
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x)
        if (at(now, x, y) == State::kOccupied) visit(x, y);
  }

  void occupy(std::vector<State>& cells, int x, int y) const {
    if (inside(x, y)) at(cells, x, y) = State::kOccupied;
  }

  void displace(int most_cells) {
    const int patch = std::max(1, static_cast<int>(2 / map_.getResolution()));
    const int columns = width_ / patch + 1;
    std::vector<std::pair<int, int>> shifts;
    const auto shift = [&] {
      return static_cast<int>(draws_.index(static_cast<std::size_t>(2 * most_cells + 1))) - most_cells;
    };
    for (int i = 0; i < columns * (height_ / patch + 1); ++i) {
      const int dx = shift();
      shifts.emplace_back(dx, shift());
    }
    std::vector<State> moved = cells_;
    std::replace(moved.begin(), moved.end(), State::kOccupied, State::kFree);
    for_each_wall([&](int x, int y) {
      const auto [dx, dy] = shifts[static_cast<std::size_t>(y / patch * columns + x / patch)];
      occupy(moved, x + dx, y + dy);
    });
    cells_ = std::move(moved);
  }

  void thicken(int by_cells, double share) {
    std::vector<State> thick = cells_;
    for_each_wall([&](int x, int y) {
      for (int dy = -by_cells; dy <= by_cells; ++dy)
        for (int dx = -by_cells; dx <= by_cells; ++dx)
          if (dx * dx + dy * dy <= by_cells * by_cells + 1 && draws_.share() < share)
            occupy(thick, x + dx, y + dy);
    });
    cells_ = std::move(thick);
  }

  void add_specks(double speck_share) {
    if (speck_share <= 0) return;
    for (State& cell : cells_)
      if (cell == State::kFree && draws_.share() < speck_share) cell = State::kOccupied;
  }

  void add_furniture(double per_m2) {
    const double cells_per_m = 1 / static_cast<double>(map_.getResolution());
    const auto free = static_cast<double>(std::count(cells_.begin(), cells_.end(), State::kFree));
    const auto side = [&] { return static_cast<int>((0.4 + 0.4 * draws_.share()) * cells_per_m); };
    for (auto left = static_cast<int>(per_m2 * free / (cells_per_m * cells_per_m)); left > 0;) {
      const auto x = static_cast<int>(draws_.index(static_cast<std::size_t>(width_)));
      const auto y = static_cast<int>(draws_.index(static_cast<std::size_t>(height_)));
      if (at(cells_, x, y) != State::kFree) continue;
      --left;
      const int width = side();
      const int height = side();
      for (int j = 0; j < height; ++j)
        for (int i = 0; i < width; ++i)
          if (i == 0 || j == 0 || i == width - 1 || j == height - 1) occupy(cells_, x + i, y + j);
    }
  }

  /// Probability that a merged cell is free: it is occupied if any of its cells is, unknown if all are.
  float merged_cell(int x, int y) const {
    float probability = 0.5F;
    for (int j = 0; j < merged_; ++j) {
      for (int i = 0; i < merged_; ++i) {
        const State cell =
            cells_[static_cast<std::size_t>(y * merged_ + j) * static_cast<std::size_t>(width_) +
                   static_cast<std::size_t>(x * merged_ + i)];
        if (cell == State::kOccupied) return 0;
        if (cell == State::kFree) probability = 1;
      }
    }
    return probability;
  }

  const Grid& map_;
  int width_;
  int height_;
  int merged_ = 1;
  RandomDraws draws_;
  std::vector<State> cells_;
};

inline mrpt::maps::COccupancyGridMap2D degraded(const mrpt::maps::COccupancyGridMap2D& map,
                                                const MapFaults& faults, std::uint64_t seed = 1) {
  return DegradedMap(map, faults, seed).grid();
}

}  // namespace psi_slam
