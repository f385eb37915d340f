// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/local_maps/local_map.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "base/portable_math.h"

namespace psi_slam {
namespace {

using Grid = mrpt::maps::COccupancyGridMap2D;

constexpr double kGrowthStep_m = 5.0;  // large, so that grids rarely grow
constexpr double kFarthest_m = 1e5;    // of a beam from the map's origin
constexpr double kMostCells = 1e8;     // 500 m by 500 m in cells of 5 cm
constexpr int kTileSide = 32;          // of the tiles whose scores are painted together, in cells

// Returns the first cell of [begin, end) that is not zero, or `end`.
const Grid::cellType* first_not_zero(const Grid::cellType* begin, const Grid::cellType* end) {
  constexpr std::ptrdiff_t kBlock = 8;
  for (std::uint64_t cells = 0; end - begin >= kBlock; begin += kBlock) {
    std::memcpy(&cells, begin, kBlock);
    if (cells != 0) break;
  }
  return std::find_if(begin, end, [](Grid::cellType cell) { return cell != 0; });
}

}  // namespace

LocalMap::LocalMap(const LocalMapOptions& options)
    : options_(options),
      grid_(std::in_place, -kGrowthStep_m, kGrowthStep_m, -kGrowthStep_m, kGrowthStep_m,
            static_cast<float>(options.resolution_m)) {
  follow_size();
}

LocalMap::LocalMap(const LocalMapOptions& options, const Grid& drawn) : options_(options), grid_(drawn) {
  options_.resolution_m = static_cast<double>(drawn.getResolution());
  follow_size();
  finish();
}

// Adapts what belongs to the cells of the occupancy grid to its size.
void LocalMap::follow_size() {
  if (!painter_) painter_.emplace(options_.smoothing_sigma_m, options_.resolution_m);
  last_scan_.assign(grid_->getRawMap().size(), 0);
  scan_ = 0;
  tile_columns_ = (static_cast<int>(grid_->getSizeX()) + kTileSide - 1) / kTileSide;
  const int tile_rows = (static_cast<int>(grid_->getSizeY()) + kTileSide - 1) / kTileSide;
  dirty_tiles_.assign(static_cast<std::size_t>(tile_columns_ * tile_rows), 0);
  scores_fit_ = false;
}

// Returns the scans that the grid can hold, and grows the grid for them. A scan that would make the grid
// larger than kMostCells is far from the map's other scans, so it cannot belong to this map.
std::vector<const Beams*> LocalMap::grow_to_hold(const std::vector<Beams>& scans) {
  Limits limits = {static_cast<double>(grid_->getXMin()), static_cast<double>(grid_->getXMax()),
                   static_cast<double>(grid_->getYMin()), static_cast<double>(grid_->getYMax())};
  const Limits before = limits;
  std::vector<const Beams*> held;
  for (const Beams& beams : scans) {
    const std::optional<Limits> grown = limits_with(beams, limits);
    if (!grown) continue;
    limits = *grown;
    held.push_back(&beams);
  }
  if (limits == before) return held;
  grid_->resizeGrid(static_cast<float>(limits.x_min), static_cast<float>(limits.x_max),
                    static_cast<float>(limits.y_min), static_cast<float>(limits.y_max), 0.5F, false);
  follow_size();
  return held;
}

// Returns the limits of a grid that also holds a scan, or nothing if that grid has more than kMostCells.
std::optional<LocalMap::Limits> LocalMap::limits_with(const Beams& beams, Limits limits) const {
  const double margin = 4 * options_.resolution_m;
  const auto hold = [&](const mrpt::math::TPoint2D& p) {
    if (!(std::abs(p.x) <= kFarthest_m && std::abs(p.y) <= kFarthest_m)) return false;
    while (p.x - margin < limits.x_min) limits.x_min -= kGrowthStep_m;
    while (p.x + margin > limits.x_max) limits.x_max += kGrowthStep_m;
    while (p.y - margin < limits.y_min) limits.y_min -= kGrowthStep_m;
    while (p.y + margin > limits.y_max) limits.y_max += kGrowthStep_m;
    return true;
  };
  if (!hold(beams.origin) || !std::all_of(beams.ends.begin(), beams.ends.end(), hold)) return std::nullopt;
  const double cells = (limits.x_max - limits.x_min) * (limits.y_max - limits.y_min) /
                       (options_.resolution_m * options_.resolution_m);
  return cells <= kMostCells ? std::optional(limits) : std::nullopt;
}

// Marks the tile of a cell whose evidence has changed.
void LocalMap::mark_dirty(std::size_t cell) {
  const std::size_t width = grid_->getSizeX();
  const std::size_t row = cell / width / kTileSide;
  dirty_tiles_[row * static_cast<std::size_t>(tile_columns_) + cell % width / kTileSide] = 1;
}

void LocalMap::draw_hit(int x, int y) {
  static_assert(Grid::OCCGRID_CELLTYPE_MIN < 0);
  const std::size_t cell = static_cast<std::size_t>(x) + static_cast<std::size_t>(y) * grid_->getSizeX();
  if (last_scan_[cell] == scan_) return;
  last_scan_[cell] = scan_;
  const Grid::cellType hit = Grid::p2l(static_cast<float>(options_.hit_probability));
  Grid::cellType& value = grid_->getRow(y)[x];
  const std::uint8_t before = painter_->evidence(value);
  grid_->updateCell_fast_occupied(&value, hit, static_cast<Grid::cellType>(Grid::OCCGRID_CELLTYPE_MIN + hit));
  if (painter_->evidence(value) != before) mark_dirty(cell);
}

// Draws hits in the cells between two beam ends on one surface, without the cells of the ends.
void LocalMap::draw_surface(int x0, int y0, int x1, int y1) {
  const int steps = std::max(std::abs(x1 - x0), std::abs(y1 - y0));
  for (int i = 1; i < steps; ++i) {
    const double share = static_cast<double>(i) / steps;
    draw_hit(x0 + floor_to_int((x1 - x0) * share + 0.5), y0 + floor_to_int((y1 - y0) * share + 0.5));
  }
}

// Draws free space along a line.
void LocalMap::draw_way(const DigitalLine& way) {
  const Grid::cellType miss = Grid::p2l(static_cast<float>(1 - options_.miss_probability));
  const auto threshold = static_cast<Grid::cellType>(Grid::OCCGRID_CELLTYPE_MAX - miss);
  Grid::cellType* const cells = grid_->getRow(0);
  std::uint16_t* const scans = last_scan_.data();
  ways_.walk(way, [&, scan = scan_](std::int64_t cell) {
    if (scans[cell] == scan) return;
    scans[cell] = scan;
    const Grid::cellType before = cells[cell];
    Grid::updateCell_fast_free(cells + cell, miss, threshold);
    // Free cells have no evidence.
    if (before < 0 && painter_->evidence(before) != painter_->evidence(cells[cell]))
      mark_dirty(static_cast<std::size_t>(cell));
  });
}

void LocalMap::insert(const std::vector<Beams>& scans) {
  const std::vector<const Beams*> held = grow_to_hold(scans);
  if (++scan_ == 0) {  // the counter overflowed
    std::fill(last_scan_.begin(), last_scan_.end(), std::uint16_t{0});
    scan_ = 1;
  }
  std::vector<DigitalLine> ways;
  for (const Beams* beams : held) draw_hits(*beams, ways);
  ways_.clear();
  for (const DigitalLine& way : ways) draw_way(way);
}

// Draws the hits of one scan and the surfaces between them. Appends all its beams, without their last
// cells, to `ways`, which insert() draws after the hits of all scans.
void LocalMap::draw_hits(const Beams& beams, std::vector<DigitalLine>& ways) {
  const int origin_x = grid_->x2idx(beams.origin.x);
  const int origin_y = grid_->y2idx(beams.origin.y);
  ways.reserve(ways.size() + beams.ends.size());
  for (std::size_t i = 0; i < beams.ends.size(); ++i) {
    const int x = grid_->x2idx(beams.ends[i].x);
    const int y = grid_->y2idx(beams.ends[i].y);
    ways.push_back(bresenham_line(origin_x, origin_y, x, y, grid_->getSizeX()));
    if (beams.hits[i]) draw_hit(x, y);
    if (i < beams.joined.size() && beams.joined[i]) {
      const mrpt::math::TPoint2D& before = i > 0 ? beams.ends[i - 1] : beams.ends.back();
      draw_surface(grid_->x2idx(before.x), grid_->y2idx(before.y), x, y);
    }
  }
}

const ScoreGrid& LocalMap::scores() {
  if (finished_) return scores_;
  if (!scores_fit_) {
    begin_scores();
    scores_.make_bounds();
  }
  paint_dirty_tiles();
  return scores_;
}

// Makes a score grid of zeros as large as the occupancy grid, and marks the tiles that have evidence.
void LocalMap::begin_scores() {
  const int width = static_cast<int>(grid_->getSizeX());
  const int height = static_cast<int>(grid_->getSizeY());
  scores_ = ScoreGrid(static_cast<double>(grid_->getXMin()), static_cast<double>(grid_->getYMin()),
                      options_.resolution_m, width, height);
  scores_fit_ = true;
  for (int y = 0; y < height; ++y) {
    const Grid::cellType* row = grid_->getRow(y);
    std::uint8_t* tile = dirty_tiles_.data() + y / kTileSide * tile_columns_;
    for (int x = 0; x < width; x += kTileSide, ++tile) {
      Grid::cellType all = 0;
      for (int i = x, end = std::min(x + kTileSide, width); i < end; ++i) all |= row[i];
      if (all < 0) *tile = 1;  // MRPT: an occupied cell is negative
    }
  }
}

// Paints the scores of the dirty tiles and within reach of them, in runs of neighbouring tiles.
void LocalMap::paint_dirty_tiles() {
  const int width = static_cast<int>(grid_->getSizeX());
  const int height = static_cast<int>(grid_->getSizeY());
  const int reach = painter_->reach_cells();
  auto tile = dirty_tiles_.begin();
  while ((tile = std::find(tile, dirty_tiles_.end(), 1)) != dirty_tiles_.end()) {
    const auto number = static_cast<int>(tile - dirty_tiles_.begin());
    const int row = number / tile_columns_;
    const auto row_end = dirty_tiles_.begin() + (row + 1) * tile_columns_;
    const auto run_end = std::find(tile, row_end, 0);
    const int column = number % tile_columns_;
    const auto columns = static_cast<int>(run_end - tile);
    const Cell first = {std::max(0, column * kTileSide - reach), std::max(0, row * kTileSide - reach)};
    const Cell end = {std::min(width, (column + columns) * kTileSide + reach),
                      std::min(height, (row + 1) * kTileSide + reach)};
    painter_->paint(*grid_, first.x, first.y, end.x, end.y, scores_.finest());
    scores_.update_bounds(first, end);
    std::fill(tile, run_end, std::uint8_t{0});
    tile = run_end;
  }
}

// Returns the smallest region that holds all observed cells and the cells within reach of their smoothing.
// Returns one cell if no cell was observed.
LocalMap::Region LocalMap::observed_region() const {
  const int width = static_cast<int>(grid_->getSizeX());
  const int height = static_cast<int>(grid_->getSizeY());
  Region region = {width, height, 0, 0};
  for (int y = 0; y < height; ++y) {
    const Grid::cellType* row = grid_->getRow(y);
    const Grid::cellType* first = first_not_zero(row, row + width);
    if (first == row + width) continue;
    const Grid::cellType* last = row + width - 1;
    while (*last == 0) --last;
    region = {std::min(region.x, static_cast<int>(first - row)), std::min(region.y, y),
              std::max(region.x_end, static_cast<int>(last - row) + 1), y + 1};
  }
  if (region.x_end <= region.x) return {0, 0, 1, 1};
  const int reach = painter_->reach_cells();
  return {std::max(0, region.x - reach), std::max(0, region.y - reach), std::min(width, region.x_end + reach),
          std::min(height, region.y_end + reach)};
}

void LocalMap::finish() {
  if (finished_) return;
  if (!scores_fit_) begin_scores();
  paint_dirty_tiles();
  const Region region = observed_region();  // drops the unused part of the last growth step
  const int width = region.x_end - region.x;
  const int height = region.y_end - region.y;
  scores_ = scores_.cropped(region.x, region.y, width, height);
  scores_.build_pyramid();
  const int half_width = (width + 1) / 2;
  observed_.assign(static_cast<std::size_t>(half_width) * static_cast<std::size_t>((height + 1) / 2),
                   std::uint8_t{0});
  for (int y = 0; y < height; ++y) {
    const Grid::cellType* row = std::as_const(*grid_).getRow(region.y + y) + region.x;
    std::uint8_t* __restrict blocks = observed_.data() + static_cast<std::ptrdiff_t>(y / 2) * half_width;
    for (int x = 0; x < width / 2; ++x) blocks[x] |= (row[2 * x] | row[2 * x + 1]) != 0 ? 1 : 0;
    if (width % 2 != 0 && row[width - 1] != 0) blocks[width / 2] = 1;
  }
  finished_ = true;
  painter_.reset();
  dirty_tiles_ = std::vector<std::uint8_t>();
  last_scan_ = std::vector<std::uint16_t>();  // an assignment of {} would keep the memory
  ways_ = LineFan();
  grid_.reset();
}

void LocalMap::pack() {
  if (!finished_ || packed_) return;
  std::vector<std::uint8_t> cells = scores_.finest().take_bytes();
  if (packed_scores_.size() == 0) {
    packed_scores_ = PackedBytes(cells);
    packed_observed_ = PackedBytes(observed_);
  }
  scores_.drop_pyramid();
  observed_ = std::vector<std::uint8_t>();
  packed_ = true;
}

void LocalMap::unpack() {
  if (!packed_) return;
  scores_.finest().give_bytes(packed_scores_.unpacked());
  scores_.build_pyramid();
  observed_ = packed_observed_.unpacked();
  packed_ = false;
}

LocalMap::Agreement LocalMap::agreement(const ScanPoints& scan,
                                        const mrpt::math::TPose2D& map_T_robot) const {
  constexpr int kHitScore = 64;  // a quarter of 255: about 1.7 sigma from a wall
  if (packed_) throw std::logic_error("LocalMap::agreement: the local map is packed, call unpack() first");
  Agreement agreement;
  const ScoreLevel& finest = scores_.finest();
  const double c = portable::cos(map_T_robot.phi);
  const double s = portable::sin(map_T_robot.phi);
  const double cells_per_m = 1 / scores_.resolution_m();
  const int width = finest.width();
  const int height = finest.height();
  const int half_width = (width + 1) / 2;
  const auto observed = [&](int x, int y) {
    if (x < 0 || y < 0 || x >= width || y >= height) return false;
    return finished_ ? observed_[static_cast<std::size_t>(y / 2 * half_width + x / 2)] != 0
                     : grid_->getRow(y)[x] != 0;
  };
  for (const auto& point : scan.points) {
    const double px = map_T_robot.x + c * static_cast<double>(point.x) - s * static_cast<double>(point.y);
    const double py = map_T_robot.y + s * static_cast<double>(point.x) + c * static_cast<double>(point.y);
    const int x = floor_to_int((px - scores_.origin_x_m()) * cells_per_m);
    const int y = floor_to_int((py - scores_.origin_y_m()) * cells_per_m);
    if (!observed(x, y)) continue;
    ++agreement.observed;
    bool hit = *finest.cell(x, y) >= kHitScore;  // true for most points
    for (int j = -1; j <= 1 && !hit; ++j) {
      const std::uint8_t* row = finest.cell(x, y + j);  // the margin makes row[-1] and row[1] valid
      hit = std::max({row[-1], row[0], row[1]}) >= kHitScore;
    }
    if (hit) ++agreement.hits;
  }
  return agreement;
}

std::size_t LocalMap::memory_bytes() const {
  const std::size_t grid = grid_ ? grid_->getRawMap().capacity() * sizeof(Grid::cellType) : 0;
  return grid + last_scan_.capacity() * sizeof(std::uint16_t) + scores_.memory_bytes() +
         observed_.capacity() + packed_scores_.memory_bytes() + packed_observed_.memory_bytes();
}

}  // namespace psi_slam
