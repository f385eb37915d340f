// SPDX-License-Identifier: BSD-3-Clause
#include "matching/point_grid.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <numeric>
#include <utility>

#include "matching/point_kernels.h"

namespace psi_slam {
namespace {

using Point = mrpt::math::TPoint2Df;

constexpr std::int64_t kSide = 64;  // rows and columns of cells, a power of two

/// A coordinate in cells.
struct InCells {
  InCells(float coordinate_m, double cells_per_m)
      : position(static_cast<double>(coordinate_m) * cells_per_m),
        cell(static_cast<std::int64_t>(std::floor(position))) {}
  /// Returns the distance to the nearer border of the cell, in cells.
  double to_border() const {
    const double behind = position - static_cast<double>(cell);
    return std::min(behind, 1 - behind);
  }
  double position;
  std::int64_t cell;
};

/// Returns the number of the cell. Rows and columns repeat after kSide.
std::size_t cell_at(std::int64_t row, std::int64_t column) {
  return static_cast<std::size_t>((row & (kSide - 1)) * kSide + (column & (kSide - 1)));
}

/// Returns the square of the distance in a key, in m^2.
float square_of(std::int64_t key) {
  const auto bits = static_cast<std::int32_t>(key >> 32);
  float square_m2 = 0;
  static_assert(sizeof bits == sizeof square_m2);
  std::memcpy(&square_m2, &bits, sizeof square_m2);
  return square_m2;
}

/// Returns how many rings of cells around a cell hold all points at most `distance_m` from any of its points,
/// or a number of rings that holds all cells, which repeat.
std::int64_t rings_within(float distance_m, double cells_per_m) {
  return static_cast<std::int64_t>(
      std::min(std::ceil(static_cast<double>(distance_m) * cells_per_m), kSide / 2.0));
}

}  // namespace

PointGrid::PointGrid(std::vector<Point> points, double cell_m)
    : points_(std::move(points)),
      cells_per_m_(1 / cell_m),
      begin_(kSide * kSide + 1),
      x_(points_.size()),
      y_(points_.size()),
      index_(points_.size()) {
  for (const Point& point : points_) ++begin_[cell_of(point) + 1];
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const std::uint32_t place = next[cell_of(points_[i])]++;
    x_[place] = points_[i].x;
    y_[place] = points_[i].y;
    index_[place] = static_cast<std::uint32_t>(i);
  }
}

std::size_t PointGrid::cell_of(const Point& point) const {
  return cell_at(InCells(point.y, cells_per_m_).cell, InCells(point.x, cells_per_m_).cell);
}

template <class Visit>
void PointGrid::visit_runs(std::int64_t row, std::int64_t first_column, std::int64_t last_column,
                           const Visit& visit) const {
  const std::size_t first = cell_at(row, first_column);
  const std::size_t last = cell_at(row, last_column);
  if (first <= last) return visit(begin_[first], begin_[last + 1]);
  visit(begin_[first], begin_[cell_at(row, kSide - 1) + 1]);
  visit(begin_[cell_at(row, 0)], begin_[last + 1]);
}

void PointGrid::nearest(const Point& at, std::size_t count, float max_distance_m,
                        std::vector<std::uint32_t>& found) const {
  found.clear();
  count = std::min(count, points_.size());
  if (count == 0) return;
  thread_local std::vector<std::int64_t> keys;
  const std::int64_t no_point = neighbour_key(max_distance_m * max_distance_m, UINT32_MAX);
  const std::size_t blocks = (count + NeighbourKeys::kBlock - 1) / NeighbourKeys::kBlock;
  keys.assign(NeighbourKeys::kBlock * blocks, no_point);
  const NeighbourKeys nearest{keys.data(), blocks};
  const PointKernels& kernels = point_kernels();
  const auto merge = [&](std::uint32_t begin, std::uint32_t end) {
    kernels.merge_nearest(
        at.x, at.y, {x_.data() + begin, y_.data() + begin, index_.data() + begin, end - begin}, nearest);
  };
  const InCells x(at.x, cells_per_m_);
  const InCells y(at.y, cells_per_m_);
  const double to_border = std::min(x.to_border(), y.to_border());
  const std::int64_t rings = rings_within(max_distance_m, cells_per_m_);
  if (2 * rings >= kSide)
    merge(0, static_cast<std::uint32_t>(points_.size()));
  else
    for (std::int64_t ring = std::min<std::int64_t>(rings, 1); ring <= rings; ++ring) {
      const double searched_m = (static_cast<double>(ring) - 1 + to_border) / cells_per_m_;
      if (ring > 1 && static_cast<double>(square_of(keys[count - 1])) < searched_m * searched_m) break;
      // Ring 1 is searched together with the cell of `at`, in whole rows.
      for (std::int64_t i = 0; i <= 2 * ring; ++i) {
        const std::int64_t row = y.cell + (i % 2 == 0 ? i / 2 : -i / 2 - 1);  // from the middle outwards
        const bool is_whole = ring == 1 || std::abs(row - y.cell) == ring;
        visit_runs(row, x.cell - ring, is_whole ? x.cell + ring : x.cell - ring, merge);
        if (!is_whole) visit_runs(row, x.cell + ring, x.cell + ring, merge);
      }
    }
  for (std::size_t i = 0; i < count && keys[i] != no_point; ++i)
    found.push_back(static_cast<std::uint32_t>(keys[i]));
}

std::vector<std::uint32_t> PointGrid::within(const Point& at, float radius_m) const {
  std::vector<std::uint32_t> found;
  const InCells x(at.x, cells_per_m_);
  const InCells y(at.y, cells_per_m_);
  const std::int64_t rings = rings_within(radius_m, cells_per_m_);
  const std::int64_t width = std::min(2 * rings + 1, kSide);  // each cell once, although the cells repeat
  for (std::int64_t row = y.cell - rings; row < y.cell - rings + width; ++row)
    visit_runs(row, x.cell - rings, x.cell - rings + width - 1, [&](std::uint32_t begin, std::uint32_t end) {
      for (std::uint32_t i = begin; i < end; ++i) {
        const float dx = x_[i] - at.x;
        const float dy = y_[i] - at.y;
        if (dx * dx + dy * dy <= radius_m * radius_m) found.push_back(index_[i]);
      }
    });
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace psi_slam
