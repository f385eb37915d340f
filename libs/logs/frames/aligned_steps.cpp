// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/aligned_steps.h"

#include <cmath>
#include <utility>

#include "logs/frames/pose_operations.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

mrpt::math::TPose2D AlignedStep::difference() const {
  return between(by_odometry, by_scans.reference_T_scan);
}

std::optional<AlignedStep> AlignedSteps::next() {
  if (!reference_) reference_ = next_frame();
  while (reference_) {
    std::optional<Frame> frame = next_frame();
    if (!frame) break;
    const mrpt::math::TPose2D motion = between(reference_->odom_T_robot, frame->odom_T_robot);
    if (motion.norm() < distance_m_ && std::abs(motion.phi) < turn_rad_) continue;
    AlignedStep step{motion, align_scans(AlignableScan(reference_->scan), AlignableScan(frame->scan), motion),
                     reference_->scan.robot_T_laser};
    reference_ = std::move(frame);
    return step;
  }
  return std::nullopt;
}

std::optional<Frame> AlignedSteps::next_frame() {
  try {
    std::optional<Frame> frame = scans_.next();
    if (frame && frame->has_odometry) return frame;
  } catch (const UserError&) {  // mapping reports it
  }
  return std::nullopt;
}

}  // namespace psi_slam
