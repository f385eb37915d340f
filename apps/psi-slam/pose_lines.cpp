// SPDX-License-Identifier: BSD-3-Clause
#include "pose_lines.h"

#include "base/number_text.h"
#include "trajectory/trajectory_file.h"

namespace psi_slam {

std::string pose_line(const LivePose& pose, PoseFormat format) {
  const mrpt::math::TPose2D& place = pose.map_T_robot;
  if (format == PoseFormat::kTum) return tum_text({{pose.time_us, place}});
  return "{\"time_s\": " + format_seconds(pose.time_us) + ", \"x_m\": " + exact_text(place.x) +
         ", \"y_m\": " + exact_text(place.y) + ", \"yaw_rad\": " + exact_text(place.phi) +
         ", \"frame\": " + std::to_string(pose.frame) +
         ", \"matched\": " + (pose.matched ? "true" : "false") + "}\n";
}

}  // namespace psi_slam
