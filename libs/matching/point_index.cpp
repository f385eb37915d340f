// SPDX-License-Identifier: BSD-3-Clause
#include "matching/point_index.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nanoflann.hpp>
#include <utility>

namespace psi_slam {
namespace {

using Point = mrpt::math::TPoint2Df;

/// Points as the data source that nanoflann expects.
struct PointSource {
  const Point* first = nullptr;
  std::size_t count = 0;
  // NOLINTBEGIN: the names are nanoflann's
  std::size_t kdtree_get_point_count() const { return count; }
  float kdtree_get_pt(std::size_t index, std::size_t axis) const {
    return axis == 0 ? first[index].x : first[index].y;
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
  // NOLINTEND
};

/// Result set for nanoflann that keeps the nearest points within a distance, the nearest first. nanoflann 1.4
/// has no such set: its set of nearest points makes it search without a limit.
class Nearest {
 public:
  using DistanceType = float;
  /// `indices` and `squares` have room for `count` points.
  Nearest(float max_square_m2, std::size_t count, std::size_t* indices, float* squares)
      : worst_(std::nextafter(max_square_m2, std::numeric_limits<float>::infinity())),
        count_(count),
        indices_(indices),
        squares_(squares) {}

  // NOLINTBEGIN: the names are nanoflann's
  std::size_t size() const { return size_; }
  bool full() const { return size_ == count_; }
  float worstDist() const { return worst_; }
  bool addPoint(float square, std::size_t index) {
    if (square >= worst_) return true;
    std::size_t place = full() ? count_ - 1 : size_++;
    for (; place > 0 && squares_[place - 1] > square; --place) {
      squares_[place] = squares_[place - 1];
      indices_[place] = indices_[place - 1];
    }
    squares_[place] = square;
    indices_[place] = index;
    if (full()) worst_ = squares_[count_ - 1];
    return true;
  }
  void sort() {}
  // NOLINTEND

 private:
  float worst_;  // points from this square of a distance on are not kept
  std::size_t count_;
  std::size_t size_ = 0;
  std::size_t* indices_;
  float* squares_;
};

/// Result set for nanoflann that collects all points within a distance, in any order.
class Within {
 public:
  using DistanceType = float;
  explicit Within(float square) : square_(square) {}
  std::vector<std::size_t> found;

  // NOLINTBEGIN: the names are nanoflann's
  std::size_t size() const { return found.size(); }
  bool full() const { return true; }
  float worstDist() const { return std::nextafter(square_, std::numeric_limits<float>::infinity()); }
  bool addPoint(float square, std::size_t index) {
    if (square <= square_) found.push_back(index);
    return true;
  }
  void sort() {}
  // NOLINTEND

 private:
  float square_;
};

}  // namespace

struct PointIndex::Tree {
  explicit Tree(const std::vector<Point>& points) : source{points.data(), points.size()} {}

  PointSource source;  // stays valid when the vector moves, because its heap memory does not move
  nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, PointSource>, PointSource, 2,
                                      std::size_t>
      index{2, source};
};

PointIndex::PointIndex(std::vector<Point> points)
    : points_(std::move(points)), tree_(std::make_unique<Tree>(points_)) {}
PointIndex::~PointIndex() = default;
PointIndex::PointIndex(PointIndex&&) noexcept = default;
PointIndex& PointIndex::operator=(PointIndex&&) noexcept = default;

void PointIndex::nearest(const Point& at, std::size_t count, float max_distance_m,
                         std::vector<std::size_t>& found) const {
  found.resize(count);
  thread_local std::vector<float> squares;
  squares.resize(count);
  Nearest result(max_distance_m * max_distance_m, count, found.data(), squares.data());
  const float query[2] = {at.x, at.y};
  if (count > 0 && !points_.empty()) tree_->index.findNeighbors(result, query, {});
  found.resize(result.size());
}

std::vector<std::size_t> PointIndex::within(const Point& at, float radius_m) const {
  Within result(radius_m * radius_m);
  const float query[2] = {at.x, at.y};
  if (!points_.empty()) tree_->index.findNeighbors(result, query, {});
  std::sort(result.found.begin(), result.found.end());
  return std::move(result.found);
}

}  // namespace psi_slam
