// SPDX-License-Identifier: BSD-3-Clause
#include "logs/doctor/input_doctor.h"

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "logs/doctor/pair_calibration.h"
#include "logs/frame_pipeline.h"
#include "logs/frames/laser_choice.h"
#include "logs/frames/log_format.h"
#include "logs/frames/log_reader.h"
#include "logs/frames/pose_operations.h"
#include "psi_slam/open_log.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr std::size_t kTracks = 90;
constexpr std::size_t kPairs = 1500;

/// Results of the first pass over the log.
struct FirstPass {
  LogFacts facts;
  std::vector<FrameMark> marks;
  std::vector<float> bearings_rad;  // bearings of the first scan
};

/// Maximum range of the first laser by its readings. If the user states one, all readings are studied, so
/// that a code between the log's maximum and the user's is found, too.
MaxRange study_max_range(const std::filesystem::path& path, LogOptions options) {
  if (options.max_range_m) options.max_range_m = std::numeric_limits<double>::infinity();
  const MaxRanges found = max_ranges_of_log(path, options);
  return found.empty() ? MaxRange() : found.begin()->second;
}

FirstPass read_once(const std::filesystem::path& path, const LogOptions& options, double max_range_m,
                    const ShareObserver& progress) {
  LogOptions unlimited = options;
  unlimited.max_range_m = std::numeric_limits<double>::infinity();
  unlimited.min_range_m = 0;
  FirstPass pass;
  LogFactsCollector collector;
  const auto log = open_log_reader(path, unlimited);
  std::string broken_off;
  try {
    while (const auto frame = log->next()) {
      if (progress) progress(log->progress());
      if (pass.bearings_rad.empty()) pass.bearings_rad = *frame->scan.bearings_rad;
      collector.add(*frame, static_cast<float>(max_range_m), static_cast<float>(options.min_range_m));
    }
  } catch (const UserError& error) {
    if (collector.marks().empty()) throw;
    broken_off = error.what();
  }
  pass.facts = collector.facts();
  pass.facts.broken_off = broken_off;
  pass.facts.contents = log->contents();
  pass.facts.format = name_of(detect_log_format(path));
  pass.marks = collector.marks();
  return pass;
}

/// Returns the field of view for make_bearings_rad(): the option, the usual value for the number of beams, or
/// the span of the bearings.
double field_of_view_rad(const FirstPass& pass, const LogOptions& options) {
  if (options.field_of_view_rad) return *options.field_of_view_rad;
  const std::vector<float>& bearings_rad = pass.bearings_rad;
  return usual_field_of_view_rad(bearings_rad.size())
      .value_or(std::abs(static_cast<double>(bearings_rad.back() - bearings_rad.front())));
}

/// Aligns scans with each other and compares their motions with odometry. Sets the members of `diagnosis`
/// that depend on odometry.
void compare_odometry_with_scans(const FirstPass& pass, const LogOptions& options,
                                 const ShareObserver& progress, LogDiagnosis& diagnosis) {
  const auto& lasers = pass.facts.contents.laser_names;
  const double stated_delay_s = delay_of_laser(stated_delays(diagnosis.options),
                                               lasers.empty() ? std::vector<std::string>() : lasers.front());
  // The studies of smaller delays include them.
  const double removed_delay_s = std::abs(stated_delay_s) > kMostEstimatedDelay_s ? stated_delay_s : 0;
  const std::vector<FrameMark> marks =
      removed_delay_s == 0 ? pass.marks : with_scan_delay(pass.marks, removed_delay_s);
  const auto tracks = tracks_from(frames_in_motion(marks, kTracks), marks.size());
  const auto pairs = calibration_pairs(marks);
  const auto moves = pairs_by_motion(marks, kComparedMotion_m, kComparedTurn_rad, kPairs);
  const auto suspects = suspected_jumps(marks, pass.facts.time.median_period_s, 100);
  const auto revisits = revisiting_pairs(marks, 0.5, 0.5, 30, 150);
  const BeamAngleEvidence evidence =
      pass.facts.contents.states_beam_angles ? BeamAngleEvidence{} : choose_beam_angle_evidence(marks);
  const FieldOfViewEvidence of_field_of_view = choose_field_of_view_evidence(marks);
  ScanLibrary library;
  for (const auto& track : tracks) library.want(track);
  library.want(pairs);
  library.want(moves);
  library.want(of_field_of_view.turning_pairs);
  library.want(of_field_of_view.straight_pairs);
  library.want(suspects);
  library.want(revisits);
  library.want(evidence.turning_pairs);
  for (const auto& turn : evidence.full_turns) library.want(turn);
  library.fetch(diagnosis.path, diagnosis.options, progress);

  std::vector<FrameMark> corrected = marks;  // for a delay without which odometry contradicts the scans
  diagnosis.odometry = check_odometry_and_delay(corrected, tracks, library);
  diagnosis.odometry_is_sound = is_sound(diagnosis.odometry);
  if (auto& offset = diagnosis.odometry.clock_offset) offset->delay_s += removed_delay_s;
  if (!diagnosis.odometry_is_sound && !diagnosis.odometry.clock_offset)
    diagnosis.field_of_view = study_field_of_view(marks, of_field_of_view, library);
  if (diagnosis.odometry_is_sound) {
    const bool are_distorted = diagnosis.sweep_direction.stated_sweep_time_s != 0;
    ScanLibrary undistorted;  // as they are mapped
    if (are_distorted) {
      LogOptions mapped = diagnosis.options;
      mapped.sweep_time_s = options.sweep_time_s;
      undistorted.want(pairs);
      undistorted.fetch(diagnosis.path, mapped);
    }
    const PairCalibration found =
        calibrate_by_pairs(diagnosis.odometry, marks, corrected, pass.facts.robot_T_laser, pairs,
                           are_distorted ? undistorted : library);
    diagnosis.laser_is_turned = found.laser_is_turned;
    if (found.laser_is_turned) library.set_mount(found.mount->robot_T_laser);
    diagnosis.mount = found.mount;
    diagnosis.delay = found.delay;
    if (diagnosis.delay) diagnosis.delay->delay_s += removed_delay_s;
    diagnosis.reversals = find_lost_reversals(align_pairs(corrected, moves, library), library);
    diagnosis.jumps = confirm_jumps(marks, suspects, library);
    diagnosis.revisits = check_revisits(marks, revisits, library);
    std::optional<double> laser_heading_rad;
    if (diagnosis.mount)
      laser_heading_rad = (between(pass.facts.robot_T_laser, diagnosis.mount->robot_T_laser)).phi;
    if (!pass.facts.contents.states_beam_angles) {
      diagnosis.beam_angles = study_beam_angles(marks, evidence, library, pass.bearings_rad,
                                                field_of_view_rad(pass, options), laser_heading_rad);
    }
  }
}

SweepDirectionStudy study_first_laser(const std::filesystem::path& path, const LogOptions& options,
                                      std::optional<double> sweep_time_s) {
  const auto log = open_log_reader(path, options);
  const std::vector<SweepDirectionStudy> studies = study_sweep_directions(*log, sweep_time_s);
  return studies.empty() ? SweepDirectionStudy{} : studies.front();
}

/// Counts the scans that would be mapped, up to damage. Returns 0 if one has a return.
std::size_t count_scans_without_returns(const std::filesystem::path& path, const LogOptions& options) {
  const auto log = open_log(path, options);
  std::size_t scans = 0;
  try {
    for (; const auto frame = log->next(); ++scans)
      if (has_return(*frame)) return 0;
  } catch (const UserError&) {
    if (scans == 0) throw;
  }
  return scans;
}

}  // namespace

LasersOfLog single_lasers(const std::filesystem::path& path, const LogOptions& options) {
  const LogFormat format = detect_log_format(path);
  const LogContents contents = open_log_reader(path, options)->contents();
  if (!combines_lasers(contents, options, format)) {
    const auto names =
        contents.laser_names.empty() ? std::vector<std::string>() : contents.laser_names.front();
    SingleLaser only{"", options};
    if (!names.empty()) only.options.scan_delay_s = options_of_laser(options, names).scan_delay_s;
    return {false, {only}};
  }
  std::vector<SingleLaser> lasers;
  for (const std::vector<std::string>& names : contents.laser_names) {
    if (names.empty() || !can_be_listed(names.front())) continue;  // or its scans have not appeared yet
    SingleLaser one{names.front(), options};
    (is_bag(format) ? one.options.scan_topic : one.options.laser) = names.front();
    one.options.scan_delay_s = options_of_laser(options, names).scan_delay_s;
    lasers.push_back(std::move(one));
  }
  if (lasers.empty()) {
    lasers.push_back({"", options});
    lasers.front().options.laser.clear();
  }
  return {true, std::move(lasers)};
}

LogDiagnosis diagnose(const std::filesystem::path& path, const LogOptions& options,
                      const ShareObserver& progress) {
  LogDiagnosis diagnosis;
  diagnosis.path = path;
  const LasersOfLog log = single_lasers(path, options);
  diagnosis.options = log.lasers.front().options;
  diagnosis.options.every_nth_scan = 1;
  diagnosis.options.sweep_time_s = 0;  // judge the log as recorded
  check_log_options(diagnosis.options);
  diagnosis.max_range = study_max_range(path, diagnosis.options);
  FirstPass pass = read_once(path, diagnosis.options,
                             diagnosis.options.max_range_m.value_or(diagnosis.max_range.max_range_m),
                             part_of(progress, 0, 0.5));
  diagnosis.facts = pass.facts;
  diagnosis.headings_are_quaternions = is_bag(detect_log_format(path));
  if (pass.facts.ranges.empty_scans == pass.facts.scans)
    diagnosis.scans_without_returns = count_scans_without_returns(path, options);
  diagnosis.facts.contents.several_lasers = log.are_combined;
  diagnosis.laser = log.lasers.front().name;
  diagnosis.own_body = find_own_body(*open_log_reader(path, diagnosis.options)).sectors();
  if (!pass.facts.contents.states_beam_angles) {
    diagnosis.used_beam_angles =
        options.beam_angles == BeamAngles::kAuto ? usual_beam_angles(pass.facts.beams) : options.beam_angles;
  }
  diagnosis.sweep_direction = study_first_laser(path, diagnosis.options, options.sweep_time_s);
  if (pass.facts.scans_without_odometry == 0)
    compare_odometry_with_scans(pass, options, part_of(progress, 0.5, 1), diagnosis);
  diagnosis.marks = std::move(pass.marks);
  diagnosis.findings = judge(diagnosis);
  return diagnosis;
}

}  // namespace psi_slam
