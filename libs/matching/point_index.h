// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPoint2D.h>

#include <cstddef>
#include <memory>
#include <vector>

namespace psi_slam {

/// Points of the plane in a k-d tree, metres. Searches are thread-safe.
class PointIndex {
 public:
  /// Builds the tree. All points must be finite; an empty vector is valid.
  explicit PointIndex(std::vector<mrpt::math::TPoint2Df> points);
  ~PointIndex();
  PointIndex(PointIndex&&) noexcept;
  PointIndex& operator=(PointIndex&&) noexcept;

  const std::vector<mrpt::math::TPoint2Df>& points() const { return points_; }

  /// Returns the indices of all points at most `radius_m` from `at`, in ascending order.
  std::vector<std::size_t> within(const mrpt::math::TPoint2Df& at, float radius_m) const;

 private:
  struct Tree;
  std::vector<mrpt::math::TPoint2Df> points_;
  std::unique_ptr<Tree> tree_;
};

}  // namespace psi_slam
