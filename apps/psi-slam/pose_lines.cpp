// SPDX-License-Identifier: BSD-3-Clause
#include "pose_lines.h"

#include <array>

#include "base/number_text.h"
#include "map/trajectory/trajectory_file.h"

namespace psi_slam {

namespace {

/// Returns the covariance of (x, y, yaw) as that of (x, y, z, roll, pitch, yaw), row by row.
std::string covariance_text(const Eigen::Matrix3d& covariance) {
  constexpr std::array<int, 6> kIndex{0, 1, -1, -1, -1, 2};  // in `covariance`; -1: always zero
  std::string text;
  for (const int row : kIndex)
    for (const int column : kIndex)
      text += (text.empty() ? "" : ", ") +
              (row < 0 || column < 0 ? std::string("0") : exact_text(covariance(row, column)));
  return '[' + text + ']';
}

}  // namespace

std::string pose_line(const LivePose& pose, PoseFormat format) {
  const mrpt::math::TPose2D& place = pose.map_T_robot;
  if (format == PoseFormat::kTum) return tum_text({{pose.time_us, place}});
  return "{\"time_s\": " + format_seconds(pose.time_us) + ", \"x_m\": " + exact_text(place.x) +
         ", \"y_m\": " + exact_text(place.y) + ", \"yaw_rad\": " + exact_text(place.phi) +
         ", \"frame\": " + std::to_string(pose.frame) +
         ", \"matched\": " + (pose.matched ? "true" : "false") +
         (pose.covariance ? ", \"covariance\": " + covariance_text(*pose.covariance) : "") + "}\n";
}

}  // namespace psi_slam
