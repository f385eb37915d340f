// SPDX-License-Identifier: BSD-3-Clause
#include "doctor/odometry_calibration.h"

#include <mrpt/core/bits_math.h>

#include <cmath>
#include <vector>

#include "doctor/input_doctor.h"
#include "doctor/odometry_check.h"
#include "frames/log_format.h"
#include "frames/log_reader.h"
#include "psi_slam/open_log.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr std::size_t kTracks = 30;
constexpr std::size_t kMostPairs = 1500;
constexpr double kDistance_m = 0.25;
const double kTurn_rad = mrpt::DEG2RAD(12.0);
constexpr double kMostDelay_s = 1.0;

LogFactsCollector read_once(const std::filesystem::path& path, const LogOptions& options) {
  LogFactsCollector collector;
  const auto log = open_log(path, options);
  try {
    while (const auto frame = log->next()) collector.add(*frame, frame->scan.max_range_m);
  } catch (const UserError&) {
    if (collector.marks().empty()) throw;  // otherwise, mapping reports the damage
  }
  return collector;
}

/// Estimates what the odometry of the log lacks as `options` read it. Aligns each scan with the scan after a
/// short motion.
OdometryCalibration estimate_once(const std::filesystem::path& path, const LogOptions& options) {
  OdometryCalibration found;
  const LogFactsCollector collector = read_once(path, options);
  const LogFacts facts = collector.facts();
  const std::vector<FrameMark>& marks = collector.marks();
  found.median_period_s = facts.time.median_period_s;
  if (facts.scans_without_odometry > 0) {
    found.obstacle = facts.scans_without_odometry == facts.scans ? "the log has no odometry"
                                                                 : "some scans have no odometry";
    return found;
  }
  const auto tracks = tracks_from(frames_in_motion(marks, kTracks), marks.size());
  const auto pairs = overlapping_pairs(marks, kDistance_m, kTurn_rad, kMostPairs);
  ScanLibrary library;
  for (const auto& track : tracks) library.want(track);
  library.want(pairs);
  library.fetch(path, options);
  std::vector<FrameMark> corrected = marks;
  if (!is_sound(check_odometry_and_delay(corrected, tracks, library))) {
    found.obstacle = "odometry contradicts the scans. See psi-slam check";
    return found;
  }
  std::vector<AlignedPair> aligned = align_pairs(corrected, pairs, library);
  found.delay = remove_scan_delay(aligned, marks);
  found.stated_mount = facts.robot_T_laser;
  found.mount = estimate_laser_mount(aligned, facts.robot_T_laser);
  return found;
}

}  // namespace

OdometryCalibration calibrate_odometry(const std::filesystem::path& path, const LogOptions& options) {
  const bool several_lasers =
      combines_lasers(open_log_reader(path, options)->contents(), options, detect_log_format(path));
  LogOptions of_one_laser = several_lasers ? options_of_first_laser(path, options) : options;
  of_one_laser.every_nth_scan = 1;
  OdometryCalibration found = estimate_once(path, of_one_laser);
  if (found.delay && found.delay->is_significant() && !options.scan_delay_s) {
    // The delay has spoilt the removal of the motion during a sweep, and the guesses for the alignment.
    of_one_laser.scan_delay_s = found.delay->delay_s;
    found = estimate_once(path, of_one_laser);
    if (found.delay) found.delay->delay_s += *of_one_laser.scan_delay_s;
    if (found.delay && std::abs(found.delay->delay_s) > kMostDelay_s) found.delay.reset();
  }
  found.several_lasers = several_lasers;
  return found;
}

}  // namespace psi_slam
