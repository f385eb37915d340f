// SPDX-License-Identifier: BSD-3-Clause
#include "sparse/step_thinned_source.h"

#include <mrpt/math/wrap2pi.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

using mrpt::math::TPose2D;

StepThinnedSource::StepThinnedSource(std::unique_ptr<FrameSource> source, const ThinningStep& step)
    : source_(std::move(source)), step_(step) {
  for (const double part : {step.distance_m, step.turn_rad})
    if (!(part >= 0) || !std::isfinite(part))
      throw std::invalid_argument("StepThinnedSource: a part of the step is negative or not finite");
}

bool StepThinnedSource::is_one_step(const TPose2D& motion) const {
  return portable::hypot(motion.x, motion.y) >= step_.distance_m ||
         std::abs(mrpt::math::wrapToPi(motion.phi)) >= step_.turn_rad;
}

std::optional<Frame> StepThinnedSource::next() {
  while (std::optional<Frame> frame = source_->next()) {
    if (!frame->has_odometry)
      throw UserError("scan " + std::to_string(frame->index) +
                      " has no odometry: only logs with odometry can be thinned. Name such logs with --logs");
    const TPose2D motion = between(odom_T_kept_, frame->odom_T_robot);
    const bool keep = kept_ == 0 || is_one_step(motion);
    if (keep) {
      odom_T_kept_ = frame->odom_T_robot;
      frame->index = kept_++;
    }
    scans_.push_back({frame->time_us, kept_ - 1, keep ? TPose2D(0, 0, 0) : motion});
    if (keep) return frame;
  }
  return std::nullopt;
}

Trajectory put_poses_back(const std::vector<ThinnedScan>& scans, const std::vector<TPose2D>& map_T_kept) {
  Trajectory trajectory;
  trajectory.reserve(scans.size());
  for (const ThinnedScan& scan : scans)
    trajectory.push_back({scan.time_us, compose(map_T_kept.at(scan.kept), scan.kept_T_scan)});
  return trajectory;
}

std::vector<TPose2D> poses_of_kept(const std::vector<ThinnedScan>& scans,
                                   const std::vector<TPose2D>& map_T_scan) {
  std::vector<TPose2D> map_T_kept;
  for (std::size_t i = 0; i < scans.size(); ++i)
    if (scans[i].kept == map_T_kept.size()) map_T_kept.push_back(map_T_scan.at(i));
  return map_T_kept;
}

}  // namespace psi_slam
