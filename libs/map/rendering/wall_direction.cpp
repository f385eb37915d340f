// SPDX-License-Identifier: BSD-3-Clause
#include "map/rendering/wall_direction.h"

#include <mrpt/math/TPoint2D.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "base/portable_math.h"
#include "logs/frames/beam_directions.h"
#include "logs/frames/pose_operations.h"

namespace psi_slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kRightAngle = M_PI / 2;
constexpr std::size_t kBins = 360;    // of the histogram over 90 degrees
constexpr std::size_t kPeakBins = 8;  // bins on both sides of the peak that count for the direction
constexpr double kPiece_m = 0.5;      // least length of a straight piece
constexpr double kStep_m = 0.3;       // largest distance between neighbouring returns of a piece
constexpr double kStraight_m = 0.02;  // largest deviation of its middle from a straight line

/// Returns whether the point in the middle of a piece lies on the line between its ends.
bool is_straight(const TPoint2D& from, const TPoint2D& middle, const TPoint2D& to) {
  const TPoint2D along = to - from;
  const TPoint2D aside = middle - from;
  return std::abs(along.x * aside.y - along.y * aside.x) <= kStraight_m * along.norm();
}

/// Histogram of directions modulo 90 degrees, weighted by length.
class DirectionHistogram {
 public:
  void add_scan(const LaserScan& scan, const TPose2D& map_T_robot) {
    const TPose2D map_T_laser = compose(map_T_robot, scan.robot_T_laser);
    const BeamDirections directions = beam_directions(scan.bearings_rad);
    std::vector<TPoint2D> piece;
    for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
      const auto range_m = static_cast<double>(scan.ranges_m[i]);
      if (!std::isfinite(range_m)) {
        piece.clear();
        continue;
      }
      const TPoint2D point = transform(map_T_laser, (*directions)[i] * range_m);
      if (!piece.empty() && (point - piece.back()).norm() > kStep_m) piece.clear();
      piece.push_back(point);
      if (piece.size() < 3 || (point - piece.front()).norm() < kPiece_m) continue;
      if (is_straight(piece.front(), piece[piece.size() / 2], point)) add(point - piece.front());
      piece.clear();
    }
  }

  /// Returns the direction of the peak.
  double peak_rad() const {
    std::size_t peak = 0;
    double most = 0;
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      const double sum = portable::hypot(around(bin).x, around(bin).y);
      if (sum > most) most = sum, peak = bin;
    }
    const TPoint2D mean = around(peak);
    return portable::atan2(mean.y, mean.x) / 4;
  }

 private:
  void add(const TPoint2D& piece) {
    const double direction_rad = portable::atan2(piece.y, piece.x);
    const double turns = direction_rad / kRightAngle;
    const double share = turns - std::floor(turns);
    TPoint2D& bin = bins_[std::min(kBins - 1, static_cast<std::size_t>(share * kBins))];
    bin += TPoint2D(portable::cos(4 * direction_rad), portable::sin(4 * direction_rad)) * piece.norm();
  }

  /// Sum of the unit vectors at four times the direction, in the bins around a bin.
  TPoint2D around(std::size_t bin) const {
    TPoint2D sum(0, 0);
    for (std::size_t i = kBins - kPeakBins; i <= kBins + kPeakBins; ++i) sum += bins_[(bin + i) % kBins];
    return sum;
  }

  std::array<TPoint2D, kBins> bins_{};
};

}  // namespace

double wall_direction_rad(const std::vector<Frame>& log, const std::vector<TPose2D>& map_T_robot) {
  DirectionHistogram histogram;
  const auto add = [&](const LaserScan& scan, const TPose2D& pose) { histogram.add_scan(scan, pose); };
  for (std::size_t i = 0; i < log.size(); ++i) for_each_scan(log[i], map_T_robot.at(i), add);
  return histogram.peak_rad();
}

}  // namespace psi_slam
