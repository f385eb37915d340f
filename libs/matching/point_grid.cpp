// SPDX-License-Identifier: BSD-3-Clause
#include "matching/point_grid.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

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

/// The nearest points found so far, the nearest first. Of equally near ones, the one with the smaller index.
class Nearest {
 public:
  /// `indices` and `squares` have room for `count` points, at least one.
  Nearest(float max_square_m2, std::size_t count, std::uint32_t* indices, float* squares)
      : worst_(max_square_m2), count_(count), indices_(indices), squares_(squares) {}

  std::size_t size() const { return size_; }
  bool is_full() const { return size_ == count_; }
  /// Points with a larger square of the distance are not kept.
  float worst() const { return worst_; }

  /// `square` is at most worst().
  void add(float square, std::uint32_t index) {
    const auto is_nearer = [&](std::size_t place) {
      return square < squares_[place] || (square == squares_[place] && index < indices_[place]);
    };
    if (is_full() && !is_nearer(count_ - 1)) return;
    std::size_t place = is_full() ? count_ - 1 : size_++;
    for (; place > 0 && is_nearer(place - 1); --place) {
      squares_[place] = squares_[place - 1];
      indices_[place] = indices_[place - 1];
    }
    squares_[place] = square;
    indices_[place] = index;
    if (is_full()) worst_ = squares_[count_ - 1];
  }

 private:
  float worst_;
  std::size_t count_;
  std::size_t size_ = 0;
  std::uint32_t* indices_;
  float* squares_;
};

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
void PointGrid::visit_cells(std::int64_t row, std::int64_t first_column, std::int64_t last_column,
                            const Point& at, const Visit& visit) const {
  for (std::int64_t column = first_column; column <= last_column; ++column) {
    const std::size_t cell = cell_at(row, column);
    for (std::uint32_t i = begin_[cell]; i < begin_[cell + 1]; ++i) {
      const float dx = x_[i] - at.x;
      const float dy = y_[i] - at.y;
      visit(dx * dx + dy * dy, index_[i]);
    }
  }
}

void PointGrid::nearest(const Point& at, std::size_t count, float max_distance_m,
                        std::vector<std::uint32_t>& found) const {
  found.resize(std::min(count, points_.size()));
  if (found.empty()) return;
  thread_local std::vector<float> squares;
  squares.resize(found.size());
  Nearest nearest(max_distance_m * max_distance_m, found.size(), found.data(), squares.data());
  const auto search_cells = [&](std::int64_t row, std::int64_t first_column, std::int64_t last_column) {
    visit_cells(row, first_column, last_column, at, [&](float square, std::uint32_t index) {
      if (square <= nearest.worst()) nearest.add(square, index);
    });
  };
  const InCells x(at.x, cells_per_m_);
  const InCells y(at.y, cells_per_m_);
  const double to_border = std::min(x.to_border(), y.to_border());
  const std::int64_t rings = rings_within(max_distance_m, cells_per_m_);
  if (2 * rings >= kSide)
    for (std::int64_t row = 0; row < kSide; ++row) search_cells(row, 0, kSide - 1);
  else
    for (std::int64_t ring = 0; ring <= rings; ++ring) {
      const double searched_m = (static_cast<double>(ring) - 1 + to_border) / cells_per_m_;
      if (ring > 0 && nearest.is_full() && static_cast<double>(nearest.worst()) < searched_m * searched_m)
        break;
      for (std::int64_t row = y.cell - ring; row <= y.cell + ring; ++row) {
        const bool is_edge = std::abs(row - y.cell) == ring;
        search_cells(row, x.cell - ring, is_edge ? x.cell + ring : x.cell - ring);
        if (!is_edge) search_cells(row, x.cell + ring, x.cell + ring);
      }
    }
  found.resize(nearest.size());
}

std::vector<std::uint32_t> PointGrid::within(const Point& at, float radius_m) const {
  std::vector<std::uint32_t> found;
  const InCells x(at.x, cells_per_m_);
  const InCells y(at.y, cells_per_m_);
  const std::int64_t rings = rings_within(radius_m, cells_per_m_);
  const std::int64_t width = std::min(2 * rings + 1, kSide);  // each cell once, although the cells repeat
  for (std::int64_t row = y.cell - rings; row < y.cell - rings + width; ++row)
    visit_cells(row, x.cell - rings, x.cell - rings + width - 1, at, [&](float square, std::uint32_t index) {
      if (square <= radius_m * radius_m) found.push_back(index);
    });
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace psi_slam
