// SPDX-License-Identifier: BSD-3-Clause
// One scan as a range image, to ask whether what another scan saw agrees with it: a point of the other that
// this scan looked straight through contradicts it, a point on what it measured agrees, and a point hidden
// behind says nothing. Of a robot with several lasers each has an image of its own, and a point that any of
// them measured agrees.
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
  /// Compares the points of another scan, `this_T_other` being its robot's pose in this scan's robot frame.
  Agreement compare(const ScanPoints& other, const mrpt::math::TPose2D& this_T_other,
                    double tolerance_m) const;

 private:
  enum class Verdict { kNothing, kContradicts, kAgrees };
  /// What one laser saw.
  struct View {
    mrpt::math::TPoint2Df origin;
    std::vector<float> nearest_m;   ///< per bin of bearings; infinite where no beam went
    std::vector<float> farthest_m;  ///< 0 where no beam went

    Verdict judge(double x, double y, double tolerance_m) const;
  };

  static std::size_t bin(double bearing_rad);

  std::vector<View> views_;
};

}  // namespace psi_slam
