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

namespace {

constexpr double kStretch_m = 1;
constexpr double kStretch_rad = 1;

/// Error of odometry over a stretch.
struct StretchError {
  double way_m = 0;     // by odometry, which has no jitter while the robot stands
  double turn_rad = 0;  // sum of absolute rotations
  double squared_m2 = 0;
  double squared_rad2 = 0;
};

/// Sums the errors of the steps in the frame of the map, so that a wrong heading does not add to the error of
/// the position.
class Stretch {
 public:
  void add(const TPose2D& odometry_motion, const TPose2D& map_motion, double map_heading_rad) {
    way_m_ += std::hypot(odometry_motion.x, odometry_motion.y);
    turn_rad_ += std::abs(mrpt::math::wrapToPi(odometry_motion.phi));
    const TPose2D off = TPose2D(0, 0, map_heading_rad) +
                        TPose2D(odometry_motion.x - map_motion.x, odometry_motion.y - map_motion.y, 0);
    off_x_m_ += off.x;
    off_y_m_ += off.y;
    off_rad_ += mrpt::math::wrapToPi(odometry_motion.phi - map_motion.phi);
  }

  bool complete() const { return way_m_ >= kStretch_m || turn_rad_ >= kStretch_rad; }
  StretchError error() const {
    return {way_m_, turn_rad_, off_x_m_ * off_x_m_ + off_y_m_ * off_y_m_, off_rad_ * off_rad_};
  }

 private:
  double way_m_ = 0;
  double turn_rad_ = 0;
  double off_x_m_ = 0;
  double off_y_m_ = 0;
  double off_rad_ = 0;
};

std::vector<StretchError> stretch_errors(const std::vector<TPose2D>& odom_T_robot,
                                         const std::vector<TPose2D>& map_T_robot) {
  std::vector<StretchError> errors;
  Stretch stretch;
  for (std::size_t i = 1; i < map_T_robot.size(); ++i) {
    stretch.add(odom_T_robot[i] - odom_T_robot[i - 1], map_T_robot[i] - map_T_robot[i - 1],
                map_T_robot[i - 1].phi);
    if (!stretch.complete()) continue;
    errors.push_back(stretch.error());
    stretch = {};
  }
  return errors;
}

/// Variances per metre and per radian: least squares of squared_rad2 = a way + b turn with a, b >= 0.
void split_heading(const std::vector<StretchError>& errors, OdometryNoise& noise) {
  double ww = 0, wt = 0, tt = 0, we = 0, te = 0;
  for (const StretchError& error : errors) {
    ww += error.way_m * error.way_m;
    wt += error.way_m * error.turn_rad;
    tt += error.turn_rad * error.turn_rad;
    we += error.way_m * error.squared_rad2;
    te += error.turn_rad * error.squared_rad2;
  }
  const double determinant = ww * tt - wt * wt;
  double a = determinant > 1e-9 * ww * tt ? (we * tt - te * wt) / determinant : -1;
  double b = determinant > 1e-9 * ww * tt ? (te * ww - we * wt) / determinant : -1;
  if (a < 0 || b < 0) {  // a negative one is set to 0
    const bool way_only = a >= 0 || (b < 0 && ww >= tt);
    a = way_only && ww > 0 ? we / ww : 0;
    b = !way_only && tt > 0 ? te / tt : 0;
  }
  noise.sigma_rad_per_root_m = std::sqrt(a);
  noise.sigma_rad_per_root_rad = std::sqrt(b);
}

}  // namespace

OdometryNoise measure_odometry_noise(const std::vector<TPose2D>& odom_T_robot,
                                     const std::vector<TPose2D>& map_T_robot) {
  if (odom_T_robot.size() != map_T_robot.size())
    throw std::invalid_argument("measure_odometry_noise: odometry and map have different numbers of poses");
  const std::vector<StretchError> errors = stretch_errors(odom_T_robot, map_T_robot);
  OdometryNoise noise;
  double way_m = 0;
  double squared_m2 = 0;
  for (const StretchError& error : errors) {
    way_m += error.way_m;
    squared_m2 += error.squared_m2;
  }
  if (way_m > 0) noise.sigma_m_per_root_m = std::sqrt(squared_m2 / (2 * way_m));
  split_heading(errors, noise);
  return noise;
}

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
