// SPDX-License-Identifier: BSD-3-Clause
// Range image of one scan, to test whether the points of another scan agree with it. A point in space that a
// beam passed through contradicts the scan. A point at the measured range agrees with it. A point hidden by a
// nearer obstacle does not count. Each laser has its own image. A point agrees with the scan if it agrees
// with any image.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <vector>

#include "matching/scan_points.h"

namespace psi_slam {

class RangeImage {
 public:
  explicit RangeImage(const ScanPoints& scan);

  struct Agreement {
    std::size_t agree = 0;
    std::size_t contradict = 0;
    double share() const {
      return agree + contradict == 0 ? 0
                                     : static_cast<double>(agree) / static_cast<double>(agree + contradict);
    }
  };
  /// Compares the points of another scan with this scan. `this_T_other` is the robot's pose at the other
  /// scan, in the robot frame of this scan.
  Agreement compare(const ScanPoints& other, const mrpt::math::TPose2D& this_T_other,
                    double tolerance_m) const;

 private:
  enum class Verdict { kNothing, kContradicts, kAgrees };
  /// Range image of one laser.
  struct View {
    mrpt::math::TPoint2Df origin;
    std::vector<float> nearest_m;   ///< smallest range in each bin of bearings; infinite without a return
    std::vector<float> farthest_m;  ///< largest range in each bin of bearings; 0 without a return

    Verdict judge(double x, double y, double tolerance_m) const;
  };

  std::vector<View> views_;
};

}  // namespace psi_slam
