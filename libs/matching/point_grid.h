// SPDX-License-Identifier: BSD-3-Clause
// Finds points near a place: surfaces near a scan, or nodes near a node. The points are sorted into square
// cells, and a search looks at the cells within its distance. The rows and columns of cells repeat after 64,
// so that few cells hold points of any extent. Points that are far apart can share a cell, and the distance
// separates them.
#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace psi_slam {

/// Position of a pose, as a point of a grid.
inline mrpt::math::TPoint2Df position(const mrpt::math::TPose2D& pose) {
  return {static_cast<float>(pose.x), static_cast<float>(pose.y)};
}

/// Points of the plane in cells, metres. Searches are thread-safe.
class PointGrid {
 public:
  /// The points must be finite and less than 2^62 cells from the origin; an empty vector is valid. `cell_m`
  /// must be positive and affects only the speed. Half the distance of the searches is best. Searches of 32
  /// cells or more compare all points.
  PointGrid(std::vector<mrpt::math::TPoint2Df> points, double cell_m);

  const std::vector<mrpt::math::TPoint2Df>& points() const { return points_; }

  /// Sets `found` to the indices of the points nearest to `at`, nearest first: at most `count` points, each
  /// at most `max_distance_m` away. Equally near points are in the order of their indices.
  void nearest(const mrpt::math::TPoint2Df& at, std::size_t count, float max_distance_m,
               std::vector<std::uint32_t>& found) const;

  /// Returns the indices of all points at most `radius_m` from `at`, in ascending order.
  std::vector<std::uint32_t> within(const mrpt::math::TPoint2Df& at, float radius_m) const;

 private:
  std::size_t cell_of(const mrpt::math::TPoint2Df& point) const;
  /// Calls `visit` with the first entry and the end of the entries of the points in some cells of a row, once
  /// or twice. The columns are at most as many as a row has.
  template <class Visit>
  void visit_runs(std::int64_t row, std::int64_t first_column, std::int64_t last_column,
                  const Visit& visit) const;

  std::vector<mrpt::math::TPoint2Df> points_;
  double cells_per_m_;
  std::vector<std::uint32_t> begin_;  ///< first entry of each cell in the following vectors, row by row
  std::vector<float> x_;
  std::vector<float> y_;
  std::vector<std::uint32_t> index_;  ///< index in points_
};

}  // namespace psi_slam
