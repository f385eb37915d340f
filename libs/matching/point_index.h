// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPoint2D.h>

#include <cstddef>
#include <memory>
#include <vector>

namespace psi_slam {

/// Points of the plane in a k-d tree. Searching it changes nothing and may be done by several threads at
/// once.
class PointIndex {
 public:
  /// Of points that are all finite; there may be none.
  explicit PointIndex(std::vector<mrpt::math::TPoint2Df> points);
  ~PointIndex();
  PointIndex(PointIndex&&) noexcept;
  PointIndex& operator=(PointIndex&&) noexcept;

  const std::vector<mrpt::math::TPoint2Df>& points() const { return points_; }

  /// Puts the numbers of up to `count` points nearest to `at` into `found`, the nearest first, those farther
  /// than `max_distance_m` left out.
  void nearest(const mrpt::math::TPoint2Df& at, std::size_t count, float max_distance_m,
               std::vector<std::size_t>& found) const;

  /// The numbers of all points at most `radius_m` from `at`, in ascending order.
  std::vector<std::size_t> within(const mrpt::math::TPoint2Df& at, float radius_m) const;

 private:
  struct Tree;
  std::vector<mrpt::math::TPoint2Df> points_;
  std::unique_ptr<Tree> tree_;
};

}  // namespace psi_slam
