// SPDX-License-Identifier: BSD-3-Clause
#include "logs/doctor/quick_check.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "logs/doctor/input_doctor.h"
#include "logs/doctor/pair_calibration.h"
#include "logs/frames/laser_choice.h"

namespace psi_slam {
namespace {

constexpr std::size_t kQuickTracks = 30;
constexpr std::size_t kQuickJumps = 30;
constexpr std::size_t kQuickRevisits = 60;

/// Compares odometry with the alignment of a few scans. `scans` are in the order of the marks.
void compare_odometry_with(const std::vector<const LaserScan*>& scans, LogDiagnosis& diagnosis) {
  const std::vector<FrameMark>& marks = diagnosis.marks;
  const auto tracks = tracks_from(frames_in_motion(marks, kQuickTracks), marks.size());
  const auto suspects = suspected_jumps(marks, diagnosis.facts.time.median_period_s, kQuickJumps);
  const auto revisits = revisiting_pairs(marks, 0.5, 0.5, 30, kQuickRevisits);
  const auto pairs = calibration_pairs(marks);
  const FieldOfViewEvidence of_field_of_view = choose_field_of_view_evidence(marks);
  ScanLibrary library;
  for (const auto& track : tracks) library.want(track);
  library.want(suspects);
  library.want(revisits);
  library.want(pairs);
  library.want(of_field_of_view.turning_pairs);
  library.want(of_field_of_view.straight_pairs);
  library.take(scans);
  std::vector<FrameMark> corrected = marks;
  diagnosis.odometry = check_odometry_and_delay(corrected, tracks, library);
  diagnosis.odometry_is_sound = is_sound(diagnosis.odometry);
  if (!diagnosis.odometry_is_sound) {
    if (!diagnosis.odometry.clock_offset)
      diagnosis.field_of_view = study_field_of_view(marks, of_field_of_view, library);
    return;
  }
  const PairCalibration found =
      calibrate_by_pairs(diagnosis.odometry, marks, corrected, diagnosis.facts.robot_T_laser, pairs, library);
  diagnosis.delay = found.delay;
  diagnosis.mount = found.mount;
  diagnosis.laser_is_turned = found.laser_is_turned;
  diagnosis.jumps = confirm_jumps(marks, suspects, library);
  diagnosis.revisits = check_revisits(marks, revisits, library);
}

/// Returns whether the headings may be those of quaternions. Frames do not tell the format of their log.
bool are_within_half_a_turn(const std::vector<FrameMark>& marks) {
  return std::all_of(marks.begin(), marks.end(),
                     [](const FrameMark& mark) { return std::abs(mark.odom_T_robot.phi) <= M_PI + 1e-6; });
}

}  // namespace

std::vector<std::string> quick_check(const std::vector<Frame>& log, std::size_t begin, std::size_t end,
                                     const LogOptions& options) {
  LogFactsCollector collector;
  std::vector<const LaserScan*> scans;
  for (std::size_t i = begin; i < end; ++i) {
    const Frame& frame = log[i];
    if (frame.scan.laser != 0 || frame.scan.ranges_m.empty()) continue;
    collector.add(frame, frame.scan.max_range_m);
    scans.push_back(&frame.scan);
  }
  if (scans.empty()) return {};
  LogDiagnosis diagnosis;
  diagnosis.options = options;
  diagnosis.facts = collector.facts();
  diagnosis.facts.contents.several_lasers = std::any_of(
      log.begin() + static_cast<std::ptrdiff_t>(begin), log.begin() + static_cast<std::ptrdiff_t>(end),
      [](const Frame& frame) { return frame.scan.laser != 0 || !frame.companions.empty(); });
  diagnosis.marks = collector.marks();
  diagnosis.headings_are_quaternions = are_within_half_a_turn(diagnosis.marks);
  if (diagnosis.facts.scans_without_odometry == 0) compare_odometry_with(scans, diagnosis);
  const std::vector<StatedDelay> delays = stated_delays(options);
  const bool is_of_one_laser = !delays.empty() && !delays.front().name.empty();
  // log.calibrate has told about scale and delay; a frame does not tell the name of its laser.
  if (options.calibrate && !options.odometry_scale) diagnosis.mount.reset();
  if (diagnosis.mount) diagnosis.mount->odometry_scale /= options.odometry_scale.value_or(1);
  if ((options.calibrate && delays.empty()) || is_of_one_laser) diagnosis.delay.reset();
  if (diagnosis.delay) diagnosis.delay->delay_s += delay_of_laser(delays, {});
  if (auto& offset = diagnosis.odometry.clock_offset) {
    offset->delay_s += delay_of_laser(delays, {});
    if (is_of_one_laser) diagnosis.odometry = {};  // units and signs by other times are unknown, too
  }
  std::vector<std::string> faults;
  for (Finding& finding : judge(diagnosis)) {
    if (finding.severity != Severity::kWarning || finding.code == "empty_scans") continue;
    faults.push_back(finding.remedy.empty() ? std::move(finding.sentence)
                                            : finding.sentence + ". Remedy: " + finding.remedy);
  }
  return faults;
}

}  // namespace psi_slam
