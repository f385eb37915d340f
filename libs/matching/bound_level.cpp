// SPDX-License-Identifier: BSD-3-Clause
#include "matching/bound_level.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "base/portable_math.h"
#include "matching/sum_kernel.h"

namespace psi_slam {
namespace {

// Rounding errors of a point's position are far below this, in cells.
constexpr double kRounding = 1e-6;

// Largest distance of a point from the robot, in cells.
double reach_cells(const SearchLattice& lattice) {
  double reach_m = 0;
  for (const auto& point : lattice.scan().points)
    reach_m = std::max(reach_m, portable::hypot(static_cast<double>(point.x), static_cast<double>(point.y)));
  return reach_m / lattice.grid().resolution_m();
}

struct HalfCells {
  int width;
  int height;
  std::vector<std::uint8_t> bytes;

  std::uint8_t* row(int y) { return bytes.data() + static_cast<std::ptrdiff_t>(y) * width; }
};

// Returns the maxima over 2 x 2 cells of [first, end), after a margin of zeros at the low ends.
HalfCells halved(const ScoreLevel& finest, Cell first, Cell end, int margin) {
  HalfCells half = {(end.x - first.x + 1) / 2 + margin, (end.y - first.y + 1) / 2 + margin, {}};
  half.bytes.assign(static_cast<std::size_t>(half.width) * static_cast<std::size_t>(half.height), 0);
  for (int y = margin; y < half.height; ++y) {
    const std::uint8_t* low = finest.cell(first.x, first.y + 2 * (y - margin));
    const std::uint8_t* high = low + finest.row_bytes();
    std::uint8_t* row = half.row(y) + margin;
    for (int x = 0; x < half.width - margin; ++x)
      row[x] = std::max(std::max(low[2 * x], low[2 * x + 1]), std::max(high[2 * x], high[2 * x + 1]));
  }
  return half;
}

// Replaces every half cell by the maximum over itself and its three neighbours at `step` half cells along +x
// and +y.
void widen(HalfCells& half, int step) {
  for (int y = 0; y < half.height; ++y) {
    std::uint8_t* row = half.row(y);
    for (int x = 0; x + step < half.width; ++x) row[x] = std::max(row[x], row[x + step]);
  }
  for (int y = 0; y + step < half.height; ++y) {
    std::uint8_t* row = half.row(y);
    const std::uint8_t* next = half.row(y + step);
    for (int x = 0; x < half.width; ++x) row[x] = std::max(row[x], next[x]);
  }
}

// Writes the maxima of four rows. The result must not overlap them, so that the compiler vectorises the loop.
void unite(const std::uint8_t* a, const std::uint8_t* b, const std::uint8_t* c, const std::uint8_t* d,
           std::ptrdiff_t size, std::uint8_t* __restrict maxima) {
  for (std::ptrdiff_t x = 0; x < size; ++x) maxima[x] = std::max(std::max(a[x], b[x]), std::max(c[x], d[x]));
}

}  // namespace

BoundLevel::BoundLevel(const SearchLattice& lattice, int stride_cells)
    : lattice_(lattice),
      stride_(stride_cells),
      phases_(stride_cells / 2),
      columns_((2 * lattice.window().n_x + stride_cells) / stride_cells),
      rows_((2 * lattice.window().n_y + stride_cells) / stride_cells) {
  while ((1 << log_phases_) < phases_) ++log_phases_;
  const SearchWindow& window = lattice.window();
  const double reach = reach_cells(lattice);
  const int turns = 2 * window.n_theta + 1;
  while (headings_ < turns && (2 * headings_ - 1) * reach * window.angular_step_rad <= stride_)
    headings_ *= 2;
  layers_.resize(static_cast<std::size_t>((turns + headings_ - 1) / headings_));

  // Only the cells that the points can reach matter.
  const ScoreGrid& grid = lattice.grid();
  const mrpt::math::TPose2D centre = lattice.pose({0, 0, 0});
  const auto edge = [&](double at_m, double origin_m, double cells, int size) {
    return static_cast<int>(std::clamp((at_m - origin_m) / grid.resolution_m() + cells, 0.0, double(size)));
  };
  const double x_cells = reach + window.n_x + 1;
  const double y_cells = reach + window.n_y + 1;
  make_tables(edge(centre.x, grid.origin_x_m(), -x_cells, grid.finest().width()),
              edge(centre.y, grid.origin_y_m(), -y_cells, grid.finest().height()),
              edge(centre.x, grid.origin_x_m(), x_cells + 1, grid.finest().width()),
              edge(centre.y, grid.origin_y_m(), y_cells + 1, grid.finest().height()));
}

// Makes tables for squares of phases_ to stride_ + 1 half cells: the sizes that points need which move by 0
// to stride_ cells. Zeros surround the planes, as wide as all blocks of a window, so sums need no bounds
// check. The zeros before a row also end the row before, and those before a plane end the plane before.
void BoundLevel::make_tables(int first_x, int first_y, int end_x, int end_y) {
  const int margin = stride_;  // half cells below the first that still have scores in their squares
  HalfCells half = halved(lattice_.grid().finest(), {first_x, first_y}, {end_x, end_y}, margin);
  for (int side = 1; side < phases_; side *= 2) widen(half, side);
  origin_ = {first_x - 2 * margin, first_y - 2 * margin};

  plane_columns_ = (half.width + phases_ - 1) / phases_;
  plane_rows_ = (half.height + phases_ - 1) / phases_;
  row_bytes_ = columns_ + plane_columns_;
  plane_bytes_ = row_bytes_ * (rows_ + plane_rows_);
  table_bytes_ = plane_bytes_ * phases_ * phases_;
  const int tables = stride_ + 2 - phases_;
  const std::ptrdiff_t size =
      table_bytes_ * tables + row_bytes_ * (rows_ + 1) + columns_ + ScoreLevel::kRunPadding;
  if (size > std::numeric_limits<std::int32_t>::max())
    throw std::invalid_argument("no bounds for a window of " + std::to_string(columns_ * stride_) + " x " +
                                std::to_string(rows_ * stride_) + " cells: expected tables of at most 2 GB");
  tables_.assign(static_cast<std::size_t>(size), 0);
  const auto row_of = [&](int table, int plane_y, int plane_x, int y) {
    return tables_.data() + table * table_bytes_ + (plane_y * phases_ + plane_x) * plane_bytes_ +
           (rows_ + y) * row_bytes_ + columns_;
  };
  for (int y = 0; y < half.height; ++y) {
    for (int plane = 0; plane < phases_; ++plane) {
      std::uint8_t* row = row_of(0, y % phases_, plane, y / phases_);
      const std::uint8_t* from = half.row(y);
      for (int x = plane, step = phases_, end = half.width; x < end; x += step) *row++ = from[x];
    }
  }
  // A square is the union of four squares that are one half cell smaller.
  for (int table = 1; table < tables; ++table) {
    for (int j = 0; j < phases_; ++j) {
      for (int i = 0; i < phases_; ++i) {
        const int next_j = (j + 1) % phases_;
        const int next_i = (i + 1) % phases_;
        const int next_row = next_j == 0 ? 1 : 0;
        const int next_column = next_i == 0 ? 1 : 0;
        for (int y = 0; y < plane_rows_; ++y)
          unite(row_of(table - 1, j, i, y), row_of(table - 1, j, next_i, y) + next_column,
                row_of(table - 1, next_j, i, y + next_row),
                row_of(table - 1, next_j, next_i, y + next_row) + next_column, plane_columns_,
                row_of(table, j, i, y));
      }
    }
  }
}

void BoundLevel::make_offsets(int number, Layer& layer) const {
  const SearchWindow& window = lattice_.window();
  const ScoreGrid& grid = lattice_.grid();
  const mrpt::math::TPose2D centre = lattice_.pose({0, 0, 0});
  const double cells_per_m = 1 / grid.resolution_m();
  const double x0 = (centre.x - grid.origin_x_m()) * cells_per_m - window.n_x - origin_.x;
  const double y0 = (centre.y - grid.origin_y_m()) * cells_per_m - window.n_y - origin_.y;
  const double to_middle = 0.5 * (headings_ - 1);  // headings from the first of the layer to its middle
  const double half_turn_rad = to_middle * window.angular_step_rad;
  const double middle_rad =
      centre.phi + (number * headings_ + to_middle - window.n_theta) * window.angular_step_rad;
  const double c = portable::cos(middle_rad) * cells_per_m;
  const double s = portable::sin(middle_rad) * cells_per_m;
  const double across = portable::sin(std::min(half_turn_rad, M_PI / 2));
  const double along = 1 - portable::cos(std::min(half_turn_rad, M_PI));
  layer.known = true;
  layer.offsets.reserve(lattice_.points());
  for (const auto& point : lattice_.scan().points) {
    const double u = c * static_cast<double>(point.x) - s * static_cast<double>(point.y);
    const double v = s * static_cast<double>(point.x) + c * static_cast<double>(point.y);
    const double dx = std::abs(v) * across + std::abs(u) * along + kRounding;
    const double dy = std::abs(u) * across + std::abs(v) * along + kRounding;
    const int x = floor_to_int(x0 + u - dx) >> 1;
    const int y = floor_to_int(y0 + v - dy) >> 1;
    const int x_last = (floor_to_int(x0 + u + dx) + stride_ - 1) >> 1;
    const int y_last = (floor_to_int(y0 + v + dy) + stride_ - 1) >> 1;
    const int side = std::max(x_last - x, y_last - y) + 1;
    const int column = x >> log_phases_;
    const int row = y >> log_phases_;
    const bool may_score =
        column + columns_ > 0 && column < plane_columns_ && row + rows_ > 0 && row < plane_rows_;
    if (!may_score) continue;
    const int plane = (y & (phases_ - 1)) * phases_ + (x & (phases_ - 1));
    layer.offsets.push_back(static_cast<std::int32_t>((side - phases_) * table_bytes_ + plane * plane_bytes_ +
                                                      (rows_ + row) * row_bytes_ + columns_ + column));
  }
}

void BoundLevel::add_bounds(int layer, Cell first, int width, int height, std::uint32_t* bounds,
                            std::ptrdiff_t bounds_row) {
  Layer& points = layers_[static_cast<std::size_t>(layer)];
  if (!points.known) make_offsets(layer, points);
  static const SumKernel kernel = sum_kernel();
  kernel(tables_.data() + first.y * row_bytes_ + first.x, row_bytes_, points.offsets.data(),
         points.offsets.size(), width, height, bounds, bounds_row);
}

}  // namespace psi_slam
