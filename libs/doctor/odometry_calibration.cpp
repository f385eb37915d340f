// SPDX-License-Identifier: BSD-3-Clause
#include "doctor/odometry_calibration.h"

#include <utility>
#include <vector>

#include "doctor/input_doctor.h"
#include "doctor/odometry_check.h"
#include "frames/laser_choice.h"
#include "frames/log_format.h"
#include "frames/log_reader.h"
#include "psi_slam/open_log.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr std::size_t kTracks = 30;

bool reads_several(const std::filesystem::path& path, const LogOptions& options) {
  return reads_several_lasers(options, detect_log_format(path)) ||
         open_log_reader(path, options)->contents().several_lasers;
}

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

}  // namespace

OdometryCalibration calibrate_odometry(const std::filesystem::path& path, const LogOptions& options) {
  OdometryCalibration calibration;
  calibration.several_lasers = reads_several(path, options);
  LogOptions of_one_laser = calibration.several_lasers ? options_of_first_laser(path, options) : options;
  of_one_laser.every_nth_scan = 1;
  const LogFactsCollector collector = read_once(path, of_one_laser);
  const LogFacts facts = collector.facts();
  const std::vector<FrameMark>& marks = collector.marks();
  calibration.median_period_s = facts.time.median_period_s;
  if (facts.scans_without_odometry > 0) {
    calibration.obstacle = facts.scans_without_odometry == facts.scans ? "the log has no odometry"
                                                                       : "some scans have no odometry";
    return calibration;
  }
  const auto tracks = tracks_from(frames_in_motion(marks, kTracks), marks.size());
  const auto pairs = calibration_pairs(marks);
  ScanLibrary library;
  for (const auto& track : tracks) library.want(track);
  library.want(pairs);
  library.fetch(path, of_one_laser);
  if (!is_sound(check_odometry(marks, tracks, library))) {
    calibration.obstacle = "odometry contradicts the scans. See psi-slam check";
    return calibration;
  }
  std::vector<AlignedPair> aligned = align_pairs(marks, pairs, library);
  calibration.delay = estimate_scan_delay(marks, reliable_turns(aligned));
  if (calibration.delay && calibration.delay->is_significant())
    set_odometry(aligned, with_scan_delay(marks, calibration.delay->delay_s));
  calibration.mount = estimate_laser_mount(aligned, facts.robot_T_laser);
  return calibration;
}

}  // namespace psi_slam
