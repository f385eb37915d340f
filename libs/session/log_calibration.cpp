// SPDX-License-Identifier: BSD-3-Clause
#include "session/log_calibration.h"

#include <mrpt/core/bits_math.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/number_text.h"
#include "base/portable_math.h"
#include "base/significance.h"
#include "logs/doctor/laser_faults.h"
#include "logs/doctor/odometry_calibration.h"
#include "logs/frames/laser_choice.h"
#include "logs/frames/log_reader.h"
#include "logs/frames/pose_operations.h"
#include "psi_slam/open_log.h"

namespace psi_slam {
namespace {

using mrpt::DEG2RAD;
using mrpt::RAD2DEG;
using mrpt::math::TPose2D;

constexpr double kScaleDeviation = 0.005;
const double kMostLogScale = portable::log(2.0);  // of odometry in metres
constexpr double kMountDeviation_m = 0.02;
const double kMountDeviation_rad = DEG2RAD(0.5);
// Slip in turns spoils the estimate by about as much as a stated pose is usually wrong.
constexpr double kUsualError_m = 0.03;
const double kUsualError_rad = DEG2RAD(0.8);

const char* const kScale = "log.odometry_scale";
const char* const kDelay = "log.scan_delay_s";
const char* const kLaserX = "log.laser_x_m";
const char* const kLaserY = "log.laser_y_m";
const char* const kLaserYaw = "log.laser_yaw_deg";
const char* const kFieldOfView = "log.field_of_view_deg";

bool is_of_mount(const CalibratedOption& estimate) {
  return estimate.option == kLaserX || estimate.option == kLaserY || estimate.option == kLaserYaw;
}

const char* const kUndetermined = "not used, because the log does not determine it well enough";

bool is_determined(const LaserMountEstimate& mount) {
  return mount.deviation_m <= kMountDeviation_m && mount.deviation_rad <= kMountDeviation_rad;
}

std::string text_of(const LaserMountEstimate& mount) {
  const TPose2D& pose = mount.robot_T_laser;
  return "x " + fixed_text(pose.x, 3) + " m, y " + fixed_text(pose.y, 3) + " m, yaw " +
         fixed_text(RAD2DEG(pose.phi), 2) + " degrees (standard deviations " +
         fixed_text(mount.deviation_m, 3) + " m and " + fixed_text(RAD2DEG(mount.deviation_rad), 2) +
         " degrees)";
}

class Calibrator {
 public:
  Calibrator(const OdometryCalibration& found, const LogOptions& options)
      : found_(found), options_(options) {}

  LogCalibration made() {
    if (!found_.obstacle.empty()) {
      say("estimates nothing, because " + found_.obstacle);
    } else {
      if (!options_.odometry_scale) use_scale();
      if (stated_delays(options_).empty())
        for (const LaserDelay& delay : found_.delays) use_delay(delay);
      if (!options_.robot_T_laser && options_.laser_mounts.empty()) use_mount();
    }
    return std::move(made_);
  }

 private:
  void say(const std::string& words) { made_.sentences.push_back("log.calibrate " + words); }

  void add(const char* option, double value, double deviation, bool is_used, const std::string& laser = "") {
    made_.estimates.push_back({"", laser, option, value, deviation, is_used});
  }

  void use_scale() {
    if (!found_.mount) return say("finds too few scans that show the scale of odometry");
    const double scale = 1 / found_.mount->odometry_scale;
    const double deviation = scale * scale * found_.mount->scale_deviation;
    const bool is_determined = deviation <= kScaleDeviation;
    const bool is_used = is_determined && std::abs(portable::log(scale)) < kMostLogScale;
    add(kScale, scale, deviation, is_used);
    say("estimates the scale of odometry: " + fixed_text(scale, 4) + " (standard deviation " +
        fixed_text(deviation, 4) + "), " +
        (is_used         ? "used"
         : is_determined ? "not used, because it differs from 1 by more than a factor of 2"
                         : kUndetermined));
  }

  void use_delay(const LaserDelay& found) {
    const std::string scans = found.laser.empty() ? "scans" : "scans of " + found.laser;
    if (!found.obstacle.empty()) return say("estimates no delay of " + scans + ", because " + found.obstacle);
    if (!found.delay) return say("finds no turns that show a delay of " + scans + " below 1 s");
    const ScanDelay& delay = *found.delay;
    const bool is_used = delay.is_significant();
    add(kDelay, delay.delay_s, delay.deviation_s, is_used, found.laser);
    say("estimates the delay of " + scans + ": " + fixed_text(delay.delay_s, 3) + " s (standard deviation " +
        fixed_text(delay.deviation_s, 3) + " s), " +
        (is_used ? "used" : "not used, because it hardly differs from 0"));
  }

  void use_mount() {
    if (found_.several_lasers) return say("leaves the poses of several lasers unchanged");
    if (!found_.mount) return say("finds too few scans that show the pose of the laser");
    const LaserMountEstimate& mount = *found_.mount;
    const TPose2D& pose = mount.robot_T_laser;
    const bool is_certain = is_determined(mount);
    const TPose2D off = between(found_.stated_mount, pose);
    const bool differs =
        off.norm() > std::max(kUsualError_m, kSignificantDeviations * mount.deviation_m) ||
        std::abs(off.phi) > std::max(kUsualError_rad, kSignificantDeviations * mount.deviation_rad);
    const bool is_used = is_certain && differs;
    add(kLaserX, pose.x, mount.deviation_m, is_used);
    add(kLaserY, pose.y, mount.deviation_m, is_used);
    add(kLaserYaw, RAD2DEG(pose.phi), RAD2DEG(mount.deviation_rad), is_used);
    say("estimates the pose of the laser: " + text_of(mount) + ", " +
        (is_used      ? "used"
         : is_certain ? "not used, because it hardly differs from the stated pose"
                      : kUndetermined));
  }

  const OdometryCalibration& found_;
  const LogOptions& options_;
  LogCalibration made_;
};

/// Names the laser of an estimated mount, so that the mount selects it. Of a log with several lasers, readers
/// select differently if a mount is stated.
void name_laser(LogCalibration& made, const std::filesystem::path& log, const LogOptions& options) {
  if (std::none_of(made.estimates.begin(), made.estimates.end(), is_of_mount)) return;
  const auto lasers = open_log_reader(log, options)->contents().laser_names;
  if (lasers.empty() || lasers.front().empty() || !can_be_listed(lasers.front().front())) return;
  for (CalibratedOption& estimate : made.estimates)
    if (is_of_mount(estimate)) estimate.laser = lasers.front().front();
}

}  // namespace

LogCalibration use_calibration(const OdometryCalibration& calibration, const LogOptions& options) {
  return Calibrator(calibration, options).made();
}

LogCalibration use_laser_faults(const LaserFaults& faults) {
  LogCalibration made;
  const auto add = [&](const char* option, double value, double deviation) {
    made.estimates.push_back({"", "", option, value, deviation, /*is_used=*/true, /*is_fault=*/true});
  };
  if (faults.field_of_view_rad) {
    const double value_deg = RAD2DEG(*faults.field_of_view_rad);
    add(kFieldOfView, value_deg, 0);
    made.sentences.push_back("the scans have a field of view of " + trimmed_text(value_deg, 1) +
                             " degrees, not " + trimmed_text(RAD2DEG(faults.stated_field_of_view_rad), 1) +
                             (faults.assumed_for_beams == 0
                                  ? " as the log states"
                                  : " as psi-slam assumes for " + counted(faults.assumed_for_beams, "beam")) +
                             "; it is used. State another one with " + kFieldOfView);
  }
  if (faults.mount && is_determined(*faults.mount)) {
    const LaserMountEstimate& mount = *faults.mount;
    const TPose2D& pose = mount.robot_T_laser;
    add(kLaserX, pose.x, mount.deviation_m);
    add(kLaserY, pose.y, mount.deviation_m);
    add(kLaserYaw, RAD2DEG(pose.phi), RAD2DEG(mount.deviation_rad));
    made.sentences.push_back("the laser is mounted at " + text_of(mount) + ", not at yaw " +
                             fixed_text(RAD2DEG(faults.stated_mount.phi), 2) +
                             " degrees as read from the log; this pose is used. State another one with " +
                             kLaserX + ", " + kLaserY + " and " + kLaserYaw);
  }
  return made;
}

LogCalibration calibrate_log(const std::filesystem::path& log, const LogOptions& options,
                             const ShareObserver& progress) {
  LogCalibration made = use_laser_faults(find_laser_faults(log, options, part_of(progress, 0, 0)));
  name_laser(made, log, options);
  if (!options.calibrate) return made;
  const LogOptions corrected = calibrated_options(options, made);
  LogCalibration calibration = use_calibration(calibrate_odometry(log, corrected, progress), corrected);
  name_laser(calibration, log, corrected);
  calibration.estimates.insert(calibration.estimates.begin(), made.estimates.begin(), made.estimates.end());
  calibration.sentences.insert(calibration.sentences.begin(), made.sentences.begin(), made.sentences.end());
  return calibration;
}

LogOptions calibrated_options(LogOptions options, const LogCalibration& calibration) {
  std::map<std::string, double> used;
  std::vector<StatedDelay> delays;
  for (const CalibratedOption& estimate : calibration.estimates) {
    if (!estimate.is_used || (!estimate.is_fault && !options.calibrate)) continue;
    if (estimate.option == kDelay) delays.push_back({estimate.laser, estimate.value});
    if (is_of_mount(estimate) && options.laser.empty()) options.laser = estimate.laser;
    used[estimate.option] = estimate.value;
  }
  if (const auto scale = used.find(kScale); scale != used.end()) options.odometry_scale = scale->second;
  if (!delays.empty()) options.scan_delay_s = scan_delay_text(delays);
  if (used.count(kFieldOfView) > 0) options.field_of_view_rad = DEG2RAD(used[kFieldOfView]);
  if (used.count(kLaserX) > 0)
    options.robot_T_laser = TPose2D{used[kLaserX], used[kLaserY], DEG2RAD(used[kLaserYaw])};
  return options;
}

bool unuse_mount(LogCalibration& calibration) {
  bool was_used = false;
  for (CalibratedOption& estimate : calibration.estimates) {
    if (!is_of_mount(estimate)) continue;
    was_used = was_used || estimate.is_used;
    estimate.is_used = false;
  }
  return was_used;
}

}  // namespace psi_slam
