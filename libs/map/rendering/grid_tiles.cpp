// SPDX-License-Identifier: BSD-3-Clause
#include "map/rendering/grid_tiles.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;

constexpr int kTileBits = 6;
static_assert(kTileSide == std::int64_t{1} << kTileBits);

/// Copies the values of a tile, or unknown cells if `values` is null, to the cells of the tile within the
/// grid.
void copy_tile(const GridSnapshot::Tile& tile, const TileValues* values, const GridLayout& layout,
               COccupancyGridMap2D& grid) {
  const std::int64_t x0 = tile.x * kTileSide - layout.x_min;
  const std::int64_t y0 = tile.y * kTileSide - layout.y_min;
  const std::int64_t x_begin = std::max<std::int64_t>(x0, 0);
  const std::int64_t x_end = std::min(x0 + kTileSide, layout.width);
  if (x_begin >= x_end) return;
  for (std::int64_t y = std::max<std::int64_t>(y0, 0); y < std::min(y0 + kTileSide, layout.height); ++y) {
    auto* row = grid.getRow(static_cast<int>(y));
    if (values == nullptr) {
      std::fill(row + x_begin, row + x_end, cell_value(0));
      continue;
    }
    const auto* from = values->data() + (y - y0) * kTileSide - x0;
    std::copy(from + x_begin, from + x_end, row + x_begin);
  }
}

bool is_before(const GridSnapshot::Tile& a, const GridSnapshot::Tile& b) {
  return std::tie(a.x, a.y) < std::tie(b.x, b.y);
}

}  // namespace

COccupancyGridMap2D::Ptr grid_of(const GridSnapshot& snapshot) {
  auto grid = unknown_grid(snapshot.layout);
  for (const GridSnapshot::Tile& tile : snapshot.tiles)
    copy_tile(tile, tile.values.get(), snapshot.layout, *grid);
  return grid;
}

bool update_grid(const GridSnapshot& before, const GridSnapshot& now, COccupancyGridMap2D& grid) {
  if (!(before.layout == now.layout)) return false;
  auto old = before.tiles.begin();
  for (const GridSnapshot::Tile& tile : now.tiles) {
    for (; old != before.tiles.end() && is_before(*old, tile); ++old)
      copy_tile(*old, nullptr, now.layout, grid);
    const bool is_known = old != before.tiles.end() && !is_before(tile, *old);
    if (!is_known || old->values != tile.values) copy_tile(tile, tile.values.get(), now.layout, grid);
    if (is_known) ++old;
  }
  for (; old != before.tiles.end(); ++old) copy_tile(*old, nullptr, now.layout, grid);
  return true;
}

GridSnapshot GridTiles::snapshot(const GridLayout& layout) {
  GridSnapshot snapshot{layout, {}};
  snapshot.tiles.reserve(tiles_.size());
  for (auto it = tiles_.begin(); it != tiles_.end();) {
    auto& [place, tile] = *it;
    if (tile.used == 0) {
      it = tiles_.erase(it);
      continue;
    }
    tile.is_shared = true;
    snapshot.tiles.push_back({place.first, place.second, tile.values});
    ++it;
  }
  return snapshot;
}

void GridTiles::apply(const FrameCells& frame, int sign) {
  Tile* tile = nullptr;
  std::pair<std::int64_t, std::int64_t> place;
  for (const TouchedCell& cell : frame.cells) {
    const std::int64_t x = frame.x_min + cell.x;
    const std::int64_t y = frame.y_min + cell.y;
    const std::pair<std::int64_t, std::int64_t> of_cell(x >> kTileBits, y >> kTileBits);
    if (tile == nullptr || of_cell != place) {
      place = of_cell;
      tile = &tiles_[place];
    }
    const std::int64_t index = (y & (kTileSide - 1)) * kTileSide + (x & (kTileSide - 1));
    apply(cell, sign, static_cast<std::size_t>(index), *tile);
  }
}

void GridTiles::apply(const TouchedCell& cell, int sign, std::size_t index, Tile& tile) {
  Counts& counts = tile.counts[index];
  const bool was_used = counts.hits != 0 || counts.passes != 0 || counts.cleared != 0;
  if ((cell.marks & kHit) != 0) counts.hits += sign;
  if ((cell.marks & kPassed) != 0) counts.passes += sign;
  if ((cell.marks & kCleared) != 0) counts.cleared += sign;
  const bool is_counted = counts.hits != 0 || counts.passes != 0;
  const bool is_used = is_counted || counts.cleared != 0;
  if (is_used && !was_used) ++tile.used;
  if (was_used && !is_used) --tile.used;
  const std::int64_t evidence =
      is_counted ? std::int64_t{counts.hits} * kHitEvidence + std::int64_t{counts.passes} * kPassEvidence
                 : (counts.cleared != 0 ? kPassEvidence : 0);
  const auto value = cell_value(evidence);
  if ((*tile.values)[index] == value) return;
  if (std::exchange(tile.is_shared, false)) tile.values = std::make_shared<TileValues>(*tile.values);
  (*tile.values)[index] = value;
}

}  // namespace psi_slam
