// SPDX-License-Identifier: BSD-3-Clause
#include "matching/bound_level.h"

#include <algorithm>
#include <cmath>

#include "base/portable_math.h"
#include "matching/point_kernels.h"
#include "matching/sum_kernel.h"

namespace psi_slam {
namespace {

// Rounding errors of a point's position are far below this, in cells.
constexpr double kRounding = 1e-6;
// Largest rounding error of a position in single precision, relative to the largest number: a few rounded
// operations.
constexpr double kFloatRounding = 8.0 / (1 << 24);

// Largest distance of a point from the robot, in cells.
double reach_cells(const SearchLattice& lattice) {
  double reach_m = 0;
  for (const auto& point : lattice.scan().points)
    reach_m = std::max(reach_m, portable::hypot(static_cast<double>(point.x), static_cast<double>(point.y)));
  return reach_m / lattice.grid().resolution_m();
}

}  // namespace

BoundLevel::BoundLevel(const SearchLattice& lattice, int stride_cells)
    : lattice_(lattice),
      stride_(stride_cells),
      columns_(blocks_of(lattice.window().n_x, stride_cells)),
      rows_(blocks_of(lattice.window().n_y, stride_cells)),
      grid_tables_(lattice.grid().bounds(stride_cells, columns_, rows_)),
      reach_cells_(reach_cells(lattice)) {
  const SearchWindow& window = lattice.window();
  const int turns = 2 * window.n_theta + 1;
  while (headings_ < turns && (2 * headings_ - 1) * reach_cells_ * window.angular_step_rad <= stride_)
    headings_ *= 2;
  layers_.resize(static_cast<std::size_t>((turns + headings_ - 1) / headings_));
  const double cells_per_m = 1 / lattice.grid().resolution_m();
  for (const auto& point : lattice.scan().points) {
    x_cells_.push_back(static_cast<float>(static_cast<double>(point.x) * cells_per_m));
    y_cells_.push_back(static_cast<float>(static_cast<double>(point.y) * cells_per_m));
  }
  if (grid_tables_ == nullptr) own_tables_ = make_tables();
}

// Makes tables of the cells that the points can reach.
BoundTables BoundLevel::make_tables() const {
  const SearchWindow& window = lattice_.window();
  const ScoreGrid& grid = lattice_.grid();
  const mrpt::math::TPose2D centre = lattice_.pose({0, 0, 0});
  const auto edge = [&](double at_m, double origin_m, double cells, int size) {
    return static_cast<int>(std::clamp((at_m - origin_m) / grid.resolution_m() + cells, 0.0, double(size)));
  };
  const double x_cells = reach_cells_ + window.n_x + 1;
  const double y_cells = reach_cells_ + window.n_y + 1;
  const int width = grid.finest().width();
  const int height = grid.finest().height();
  const Cell first = {edge(centre.x, grid.origin_x_m(), -x_cells, width),
                      edge(centre.y, grid.origin_y_m(), -y_cells, height)};
  const Cell end = {edge(centre.x, grid.origin_x_m(), x_cells + 1, width),
                    edge(centre.y, grid.origin_y_m(), y_cells + 1, height)};
  BoundTables tables(stride_, first, end, columns_, rows_);
  tables.update(grid.finest(), first, end);
  return tables;
}

void BoundLevel::make_offsets(int number, Layer& layer) {
  const SearchWindow& window = lattice_.window();
  const ScoreGrid& grid = lattice_.grid();
  const BoundTables& tables = this->tables();
  const mrpt::math::TPose2D centre = lattice_.pose({0, 0, 0});
  const double cells_per_m = 1 / grid.resolution_m();
  const double first_x = (centre.x - grid.origin_x_m()) * cells_per_m - window.n_x - tables.origin().x;
  const double first_y = (centre.y - grid.origin_y_m()) * cells_per_m - window.n_y - tables.origin().y;
  const double to_middle = 0.5 * (headings_ - 1);  // headings from the first of the layer to its middle
  const double half_turn_rad = to_middle * window.angular_step_rad;
  const double middle_rad =
      centre.phi + (number * headings_ + to_middle - window.n_theta) * window.angular_step_rad;
  const double farthest = std::max(std::abs(first_x), std::abs(first_y)) + 2 * reach_cells_ + stride_;
  SquareSearch search;
  search.middle = {static_cast<float>(first_x), static_cast<float>(first_y),
                   static_cast<float>(portable::cos(middle_rad)),
                   static_cast<float>(portable::sin(middle_rad))};
  search.across = static_cast<float>(portable::sin(std::min(half_turn_rad, M_PI / 2)));
  search.along = static_cast<float>(1 - portable::cos(std::min(half_turn_rad, M_PI)));
  // Single precision halves the time. The squares are larger by its rounding errors.
  search.rounding = static_cast<float>(kRounding + kFloatRounding * farthest);
  search.stride = stride_;
  search.window_columns = columns_;
  search.window_rows = rows_;
  search.layout = tables.layout();
  const std::size_t points = x_cells_.size();
  squares_.resize(points);
  point_kernels().find_squares(search, x_cells_.data(), y_cells_.data(), points, squares_.data());
  layer.known = true;
  layer.offsets.resize(points);
  std::size_t inside = 0;
  for (const std::int32_t square : squares_) {
    layer.offsets[inside] = square;
    inside += square >= 0 ? 1 : 0;
  }
  layer.offsets.resize(inside);
}

void BoundLevel::add_bounds(int layer, Cell first, int width, int height, std::uint32_t* bounds,
                            std::ptrdiff_t bounds_row) {
  Layer& points = layers_[static_cast<std::size_t>(layer)];
  if (!points.known) make_offsets(layer, points);
  static const SumKernel kernel = sum_kernel();
  const std::ptrdiff_t row_bytes = tables().layout().row_bytes;
  kernel(tables().bytes() + first.y * row_bytes + first.x, row_bytes, points.offsets.data(),
         points.offsets.size(), width, height, bounds, bounds_row);
}

}  // namespace psi_slam
