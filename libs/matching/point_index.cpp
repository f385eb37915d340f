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

std::vector<std::size_t> PointIndex::within(const Point& at, float radius_m) const {
  Within result(radius_m * radius_m);
  const float query[2] = {at.x, at.y};
  if (!points_.empty()) tree_->index.findNeighbors(result, query, {});
  std::sort(result.found.begin(), result.found.end());
  return std::move(result.found);
}

}  // namespace psi_slam
