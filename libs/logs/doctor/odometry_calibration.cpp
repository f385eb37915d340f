// SPDX-License-Identifier: BSD-3-Clause
#include "logs/doctor/odometry_calibration.h"

#include <cmath>
#include <cstddef>
#include <vector>

#include "logs/doctor/input_doctor.h"
#include "logs/doctor/pair_calibration.h"
#include "logs/frames/laser_choice.h"
#include "logs/frames/log_format.h"
#include "logs/frames/log_reader.h"
#include "psi_slam/open_log.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr std::size_t kCalibrationTracks = 30;
constexpr double kShareOfReading = 0.2;  // of the time of an estimate, for each reading of the log

LogFactsCollector read_once(const std::filesystem::path& path, const LogOptions& options,
                            const ShareObserver& progress) {
  LogFactsCollector collector;
  const auto log = open_log(path, options);
  try {
    while (const auto frame = log->next()) {
      collector.add(*frame, frame->scan.max_range_m);
      if (progress) progress(log->progress());
    }
  } catch (const UserError&) {
    if (collector.marks().empty()) throw;  // otherwise, mapping reports the damage
  }
  return collector;
}

/// Estimates by the scans of one laser; see OdometryCalibration.
struct LaserEstimate {
  std::string obstacle;
  mrpt::math::TPose2D stated_mount;
  std::optional<ScanDelay> delay;
  std::optional<LaserMountEstimate> mount;
};

/// Estimates what the odometry of the log lacks as `options` read it. Aligns each scan with the scan after a
/// short motion.
LaserEstimate estimate_once(const std::filesystem::path& path, const LogOptions& options,
                            const ShareObserver& progress) {
  LaserEstimate found;
  const LogFactsCollector collector = read_once(path, options, part_of(progress, 0, kShareOfReading));
  const LogFacts facts = collector.facts();
  const std::vector<FrameMark>& marks = collector.marks();
  if (facts.scans_without_odometry > 0) {
    found.obstacle = facts.scans_without_odometry == facts.scans ? "the log has no odometry"
                                                                 : "some scans have no odometry";
    return found;
  }
  const auto tracks = tracks_from(frames_in_motion(marks, kCalibrationTracks), marks.size());
  const auto pairs = calibration_pairs(marks);
  ScanLibrary library;
  for (const auto& track : tracks) library.want(track);
  library.want(pairs);
  library.fetch(path, options, part_of(progress, kShareOfReading, 2 * kShareOfReading));
  std::vector<FrameMark> corrected = marks;
  const OdometryAgreement odometry = check_odometry_and_delay(corrected, tracks, library);
  if (!is_sound(odometry)) {
    found.obstacle = "odometry contradicts the scans. See psi-slam check";
    return found;
  }
  found.stated_mount = facts.robot_T_laser;
  const PairCalibration of_pairs = calibrate_by_pairs(odometry, marks, corrected, facts.robot_T_laser, pairs,
                                                      library, part_of(progress, 2 * kShareOfReading, 1));
  found.delay = of_pairs.delay;
  found.mount = of_pairs.mount;
  return found;
}

/// Estimates twice if the scans are stamped late and state their sweep time: the delay has spoilt the removal
/// of the motion during a sweep.
LaserEstimate estimate(const std::filesystem::path& path, LogOptions options, const ShareObserver& progress) {
  const bool may_be_bent = is_bag(detect_log_format(path)) || options.sweep_time_s.value_or(0) > 0;
  const bool may_repeat = may_be_bent && stated_delays(options).empty();
  LaserEstimate found = estimate_once(path, options, part_of(progress, 0, may_repeat ? 0.5 : 1));
  if (!may_repeat || !found.delay || !found.delay->is_significant()) return found;
  const double delay_s = found.delay->delay_s;
  options.scan_delay_s = scan_delay_text({{"", delay_s}});
  found = estimate_once(path, options, part_of(progress, 0.5, 1));
  if (found.delay) found.delay->delay_s += delay_s;
  if (found.delay && std::abs(found.delay->delay_s) > kMostEstimatedDelay_s) found.delay.reset();
  return found;
}

}  // namespace

OdometryCalibration calibrate_odometry(const std::filesystem::path& path, const LogOptions& options,
                                       const ShareObserver& progress) {
  const auto [are_combined, lasers] = single_lasers(path, options);
  const std::size_t estimated = stated_delays(options).empty() ? lasers.size() : 1;
  OdometryCalibration calibration;
  calibration.several_lasers = are_combined;
  for (std::size_t i = 0; i < estimated; ++i) {
    LogOptions alone = lasers[i].options;
    alone.every_nth_scan = 1;
    const auto share = [&](std::size_t laser) {
      return static_cast<double>(laser) / static_cast<double>(estimated);
    };
    const LaserEstimate found = estimate(path, alone, part_of(progress, share(i), share(i + 1)));
    calibration.delays.push_back({lasers[i].name, found.delay, found.obstacle});
    if (i > 0) continue;
    calibration.obstacle = found.obstacle;
    calibration.stated_mount = found.stated_mount;
    calibration.mount = found.mount;
    if (!found.obstacle.empty()) break;
  }
  return calibration;
}

}  // namespace psi_slam
