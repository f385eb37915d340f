// SPDX-License-Identifier: BSD-3-Clause
#include "matching/search_lattice.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <tuple>

#include "base/portable_math.h"
#include "matching/point_kernels.h"
#include "matching/sum_kernel.h"

namespace psi_slam {
namespace {

std::int64_t squared_distance(const LatticePose& pose) {
  const std::int64_t x = pose.x;
  const std::int64_t y = pose.y;
  const std::int64_t theta = pose.theta;
  return x * x + y * y + theta * theta;
}

// Returns the binary logarithm of a stride, which is a power of two. A right shift by this logarithm divides
// by the stride and rounds down, also for negative numbers.
int log2_of(int stride) {
  int log2 = 0;
  while ((1 << log2) < stride) ++log2;
  return log2;
}

Cell in_level(const UnclippedCells& cells, Cell cell) {
  return {(cell.x + cells.shift.x) >> cells.log_stride, (cell.y + cells.shift.y) >> cells.log_stride};
}

}  // namespace

bool Candidate::better_than(const Candidate& other) const {
  if (sum != other.sum) return sum > other.sum;
  const std::int64_t distance = squared_distance(pose);
  const std::int64_t other_distance = squared_distance(other.pose);
  if (distance != other_distance) return distance < other_distance;
  return std::tie(pose.theta, pose.y, pose.x) < std::tie(other.pose.theta, other.pose.y, other.pose.x);
}

bool ExcludedRegion::contains(const LatticePose& pose) const {
  return std::abs(pose.x - centre.x) < cells && std::abs(pose.y - centre.y) < cells &&
         std::abs(pose.theta - centre.theta) < turns;
}

std::array<ShiftBlock, 4> outside(const ExcludedRegion& excluded, int theta, const ShiftBlock& block) {
  if (std::abs(theta - excluded.centre.theta) >= excluded.turns) return {block};
  const int x_end = block.first.x + block.width;
  const int y_end = block.first.y + block.height;
  const auto edge = [](int centre, std::int64_t offset, int from, int to) {
    return static_cast<int>(std::clamp<std::int64_t>(centre + offset, from, to));
  };
  const std::int64_t cells = excluded.cells;
  const int left = edge(excluded.centre.x, 1 - cells, block.first.x, x_end);
  const int right = edge(excluded.centre.x, cells, left, x_end);
  const int low = edge(excluded.centre.y, 1 - cells, block.first.y, y_end);
  const int high = edge(excluded.centre.y, cells, low, y_end);
  return {{{block.first, block.width, low - block.first.y},
           {{block.first.x, high}, block.width, y_end - high},
           {{block.first.x, low}, left - block.first.x, high - low},
           {{right, low}, x_end - right, high - low}}};
}

SearchLattice::SearchLattice(const ScoreGrid& grid, const ScanPoints& scan,
                             const mrpt::math::TPose2D& map_T_robot, const SearchWindow& window)
    : grid_(&grid),
      scan_(&scan),
      window_(window),
      centre_(map_T_robot),
      points_(scan.points.size()),
      cells_(new Cell[static_cast<std::size_t>(2 * window.n_theta + 1) * points_]),
      turned_(static_cast<std::size_t>(2 * window.n_theta + 1), false) {}

void SearchLattice::turn_scan(int theta) const {
  const auto turn = static_cast<std::size_t>(theta + window_.n_theta);
  const double cells_per_m = 1 / grid_->resolution_m();
  const double x0 = (centre_.x - grid_->origin_x_m()) * cells_per_m;
  const double y0 = (centre_.y - grid_->origin_y_m()) * cells_per_m;
  const double heading = centre_.phi + theta * window_.angular_step_rad;
  const CellPlacement<double> placement = {x0, y0, portable::cos(heading) * cells_per_m,
                                           portable::sin(heading) * cells_per_m};
  if (points_ > 0)
    point_kernels().place(placement, &scan_->points.front().x, points_, cells_.get() + turn * points_);
  turned_[turn] = true;
}

mrpt::math::TPose2D SearchLattice::pose(const LatticePose& steps) const {
  mrpt::math::TPose2D pose(centre_.x + steps.x * window_.linear_step_m,
                           centre_.y + steps.y * window_.linear_step_m,
                           centre_.phi + steps.theta * window_.angular_step_rad);
  pose.normalizePhi();
  return pose;
}

void ShiftSums::compute(const ScoreLevel& level, const Cell* cells, std::size_t points, Cell shift, int width,
                        int height) {
  row_ = (width + kSumLanes - 1) / kSumLanes * kSumLanes;
  sums_.assign(static_cast<std::size_t>(row_ * height), 0);
  offsets_.resize(points);
  std::size_t inside = 0;
  // Up to the last of these cells, all runs lie inside the grid and its margin.
  UnclippedCells unclipped;
  unclipped.shift = shift;
  unclipped.log_stride = log2_of(level.stride_cells());
  unclipped.first = {-ScoreLevel::kMargin, -ScoreLevel::kMargin};
  unclipped.last = {level.width() + ScoreLevel::kMargin - width,
                    level.height() + ScoreLevel::kMargin - height};
  unclipped.row_bytes = static_cast<std::int32_t>(level.row_bytes());
  point_kernels().find_offsets(unclipped, cells, points, offsets_.data());
  for (std::size_t p = 0; p < points; ++p) {
    const std::int32_t offset = offsets_[p];
    if (offset != PointKernels::kClipped)
      offsets_[inside++] = offset;
    else
      add_clipped(level, in_level(unclipped, cells[p]), width, height);
  }
  static const SumKernel kernel = sum_kernel();
  kernel(level.cell(0, 0), level.row_bytes(), offsets_.data(), inside, width, height, sums_.data(), row_);
}

void ShiftSums::add_clipped(const ScoreLevel& level, Cell cell, int width, int height) {
  const int x_first = std::max(0, -1 - cell.x);
  const int x_last = std::min(width, level.width() - cell.x);
  const int y_first = std::max(0, -1 - cell.y);
  const int y_last = std::min(height, level.height() - cell.y);
  if (x_first >= x_last) return;
  for (int y = y_first; y < y_last; ++y) {
    std::uint32_t* sums = sums_.data() + y * row_ + x_first;
    const std::uint8_t* scores = level.cell(cell.x + x_first, cell.y + y);
    for (int x = 0; x < x_last - x_first; ++x) sums[x] += scores[x];
  }
}

}  // namespace psi_slam
