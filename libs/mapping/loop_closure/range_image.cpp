// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/range_image.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/portable_math.h"
#include "mapping/loop_closure/bearing_bin.h"

namespace psi_slam {

RangeImage::RangeImage(const ScanPoints& scan) {
  for_each_laser(scan, [&](const mrpt::math::TPoint2Df& origin, std::size_t first, std::size_t end) {
    View view{origin, std::vector<float>(kBearingBins, std::numeric_limits<float>::infinity()),
              std::vector<float>(kBearingBins, 0.0F)};
    for (std::size_t i = first; i < end; ++i) {
      const float dx = scan.points[i].x - origin.x;
      const float dy = scan.points[i].y - origin.y;
      const std::size_t b = bearing_bin(static_cast<double>(dx), static_cast<double>(dy));
      const float range = portable::hypot(dx, dy);
      view.nearest_m[b] = std::min(view.nearest_m[b], range);
      view.farthest_m[b] = std::max(view.farthest_m[b], range);
    }
    views_.push_back(std::move(view));
  });
}

RangeImage::Verdict RangeImage::View::judge(double x, double y, double tolerance_m) const {
  const double dx = x - static_cast<double>(origin.x);
  const double dy = y - static_cast<double>(origin.y);
  const std::size_t b = bearing_bin(dx, dy);
  if (farthest_m[b] <= 0) return Verdict::kNothing;
  const double range = portable::hypot(dx, dy);
  if (range > static_cast<double>(farthest_m[b]) + tolerance_m)
    return Verdict::kNothing;  // hidden behind the measured points
  return range < static_cast<double>(nearest_m[b]) - tolerance_m ? Verdict::kContradicts : Verdict::kAgrees;
}

RangeImage::Agreement RangeImage::compare(const ScanPoints& other, const mrpt::math::TPose2D& this_T_other,
                                          double tolerance_m) const {
  Agreement result;
  const double c = portable::cos(this_T_other.phi);
  const double s = portable::sin(this_T_other.phi);
  for (const auto& point : other.points) {
    const double x = this_T_other.x + c * static_cast<double>(point.x) - s * static_cast<double>(point.y);
    const double y = this_T_other.y + s * static_cast<double>(point.x) + c * static_cast<double>(point.y);
    Verdict verdict = Verdict::kNothing;
    for (const View& view : views_) verdict = std::max(verdict, view.judge(x, y, tolerance_m));
    if (verdict == Verdict::kAgrees) ++result.agree;
    if (verdict == Verdict::kContradicts) ++result.contradict;
  }
  return result;
}

}  // namespace psi_slam
