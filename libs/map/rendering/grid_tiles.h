// SPDX-License-Identifier: BSD-3-Clause
// The evidence of many frames about each cell, in square tiles. Frames can be added and removed in any order:
// the counts are sums, so the cells depend only on the frames that remain.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "map/rendering/frame_cells.h"
#include "map/rendering/grid_layout.h"

namespace psi_slam {

/// Side of a tile, in cells.
inline constexpr std::int64_t kTileSide = 64;

/// Values of the cells of a tile, row by row, see cell_value().
using TileValues =
    std::array<mrpt::maps::COccupancyGridMap2D::cellType, static_cast<std::size_t>(kTileSide* kTileSide)>;

/// The values of a map at one moment, which never change. Tile (x, y) begins at cell x and y times kTileSide.
/// Sorted by x, then y; cells outside all tiles are unknown.
struct GridSnapshot {
  struct Tile {
    std::int64_t x = 0;
    std::int64_t y = 0;
    std::shared_ptr<const TileValues> values;
  };
  GridLayout layout;
  std::vector<Tile> tiles;
};

/// Returns the map as MRPT's grid.
mrpt::maps::COccupancyGridMap2D::Ptr grid_of(const GridSnapshot& snapshot);

/// Makes `grid`, which is grid_of(before), equal to grid_of(now), at a cost that grows with the difference.
/// Returns false, and changes nothing, if the extents differ.
bool update_grid(const GridSnapshot& before, const GridSnapshot& now, mrpt::maps::COccupancyGridMap2D& grid);

class GridTiles {
 public:
  /// Adds the evidence of a frame.
  void add(const FrameCells& frame) { apply(frame, 1); }
  /// Removes the evidence of a frame that was added with the same cells.
  void remove(const FrameCells& frame) { apply(frame, -1); }

  /// Returns the tiles, and frees those that are empty. Costs a few bytes for each tile; their values are
  /// copied only when they change.
  GridSnapshot snapshot(const GridLayout& layout);

 private:
  struct Counts {
    std::int32_t hits = 0;
    std::int32_t passes = 0;
    std::int32_t cleared = 0;
  };
  struct Tile {
    std::vector<Counts> counts = std::vector<Counts>(TileValues().size());
    std::size_t used = 0;  ///< number of cells with a count other than 0
    std::shared_ptr<TileValues> values = std::make_shared<TileValues>();
    bool is_shared = false;  ///< whether a snapshot may hold `values`
  };

  void apply(const FrameCells& frame, int sign);
  static void apply(const TouchedCell& cell, int sign, std::size_t index, Tile& tile);

  std::map<std::pair<std::int64_t, std::int64_t>, Tile> tiles_;
};

}  // namespace psi_slam
