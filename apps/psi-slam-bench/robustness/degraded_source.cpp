// SPDX-License-Identifier: BSD-3-Clause
#include "robustness/degraded_source.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace psi_slam {

using mrpt::math::TPose2D;

DegradedSource::DegradedSource(std::unique_ptr<FrameSource> source, const DegradationOptions& options)
    : source_(std::move(source)), options_(options), draws_(options.seed, "odometry", 0) {
  if (options.keep_every_nth == 0) throw std::invalid_argument("DegradedSource: no scan would be kept");
  if (options.field_of_view_rad && !(*options.field_of_view_rad > 0))
    throw std::invalid_argument("DegradedSource: the field of view must be positive");
}

std::optional<Frame> DegradedSource::next() {
  while (auto frame = source_->next()) {
    spoil_odometry(*frame);  // also of skipped frames, so that the noise does not depend on keep_every_nth
    if (read_++ % options_.keep_every_nth != 0) continue;
    frame->index = kept_++;
    narrow(frame->scan);
    for (CompanionScan& companion : frame->companions) narrow(companion.scan);
    return frame;
  }
  return std::nullopt;
}

void DegradedSource::spoil_odometry(Frame& frame) {
  if (options_.no_odometry) {
    frame.has_odometry = false;
    frame.odom_T_robot = {};
    for (CompanionScan& companion : frame.companions) companion.frame_T_robot = {};
    return;
  }
  if (!(options_.odometry_noise_scale > 1)) return;
  const TPose2D odom_T_robot = frame.odom_T_robot;
  if (!last_odom_T_robot_) {
    spoilt_odom_T_robot_ = odom_T_robot;
  } else {
    const double share = std::sqrt(options_.odometry_noise_scale * options_.odometry_noise_scale - 1);
    const OdometryNoise& natural = options_.natural_noise;
    TPose2D motion = odom_T_robot - *last_odom_T_robot_;
    const double way_m = std::hypot(motion.x, motion.y);
    const double turn_rad = std::abs(mrpt::math::wrapToPi(motion.phi));
    const double sigma_m = share * natural.sigma_m_per_root_m * std::sqrt(way_m);
    const double sigma_rad = share * std::hypot(natural.sigma_rad_per_root_m * std::sqrt(way_m),
                                                natural.sigma_rad_per_root_rad * std::sqrt(turn_rad));
    motion.x += sigma_m * draws_.normal();
    motion.y += sigma_m * draws_.normal();
    motion.phi += sigma_rad * draws_.normal();
    spoilt_odom_T_robot_ = spoilt_odom_T_robot_ + motion;
    spoilt_odom_T_robot_.normalizePhi();
  }
  last_odom_T_robot_ = odom_T_robot;
  frame.odom_T_robot = spoilt_odom_T_robot_;
}

void DegradedSource::narrow(LaserScan& scan) const {
  if (!options_.field_of_view_rad || !scan.bearings_rad) return;
  constexpr double kRounding_rad = 1e-5;  // bearings are floats
  const std::size_t beams = std::min(scan.ranges_m.size(), scan.bearings_rad->size());
  for (std::size_t i = 0; i < beams; ++i)
    if (std::abs(static_cast<double>((*scan.bearings_rad)[i])) >
        *options_.field_of_view_rad / 2 + kRounding_rad)
      scan.ranges_m[i] = std::numeric_limits<float>::quiet_NaN();
}

}  // namespace psi_slam
