// SPDX-License-Identifier: BSD-3-Clause
// Checks a log before it is mapped: what it contains and what looks wrong, with a remedy for each fault.
// Odometry is compared with the alignment of a sample of scans from the whole log.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/share_observer.h"
#include "logs/doctor/beam_angle_study.h"
#include "logs/doctor/field_of_view_study.h"
#include "logs/doctor/log_facts.h"
#include "logs/doctor/odometry_check.h"
#include "logs/doctor/pair_alignment.h"
#include "logs/frames/max_range_study.h"
#include "logs/frames/own_body.h"
#include "logs/sweep_direction_study.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

enum class Severity : std::uint8_t {
  kNote,     ///< information; the log can be mapped as it is
  kWarning,  ///< a fault that makes the map worse
};

/// One statement about a log.
struct Finding {
  std::string code;  ///< identifier for programs: "mirrored_scan", "time_backwards", ...
  Severity severity = Severity::kNote;
  std::string sentence;
  std::string remedy;  ///< an .ini line ("log.mirrored = true") or advice; may be empty
};

/// All measurements and the findings that follow from them.
struct LogDiagnosis {
  std::filesystem::path path;
  LogFacts facts;
  std::size_t scans_without_returns = 0;  ///< number of all scans if none of any laser has a return, else 0
  MaxRange max_range;                     ///< by the readings; a maximum in `options` does not limit it
  SweepDirectionStudy sweep_direction;    ///< without scans if no sweep time is stated
  LogOptions options;                     ///< options used to read the log
  std::string laser;                      ///< laser that is judged; see SingleLaser::name
  BeamAngles used_beam_angles = BeamAngles::kAuto;  ///< kAuto if the log states its angles
  std::vector<BodySector> own_body;                 ///< beams that see the robot itself
  OdometryAgreement odometry;
  bool headings_are_quaternions = false;  ///< of odometry, which then cannot be degrees
  bool odometry_is_sound = false;  ///< units and signs are right; if not, the members up to beam_angles are
                                   ///< not set
  FieldOfViewStudy field_of_view;  ///< set only if odometry is not sound
  bool laser_is_turned = false;    ///< the heading of `mount` shows that the stated one is wrong
  LostReversals reversals;
  OdometryJumps jumps;
  RevisitAgreement revisits;
  std::optional<ScanDelay> delay;
  std::optional<LaserMountEstimate> mount;  ///< by odometry that is corrected for a significant delay
  BeamAngleStudy beam_angles;
  std::vector<FrameMark> marks;  ///< time and odometry of every frame of the log
  std::vector<Finding> findings;
};

/// Reads the whole log and judges it as recorded: ignores `options.every_nth_scan`, and `sweep_time_s` for
/// all but the study of the sweep direction. Judges the first of several lasers. Judges a truncated or
/// damaged log up to the damage. Reports the progress of reading. Throws UserError if the first scan cannot
/// be read.
LogDiagnosis diagnose(const std::filesystem::path& path, const LogOptions& options = {},
                      const ShareObserver& progress = {});

/// A laser of a log.
struct SingleLaser {
  std::string name;    ///< name for options such as log.scan_delay_s; empty if lasers are not combined
  LogOptions options;  ///< read this laser alone, with its stated delay
};

struct LasersOfLog {
  bool are_combined = false;  ///< see combines_lasers()
  std::vector<SingleLaser> lasers;
};

/// Returns the lasers that `options` select and that send scans at the beginning of the log, at least one.
/// Omits lasers whose names cannot be written in a list of log.laser. Throws UserError if the log is
/// unreadable.
LasersOfLog single_lasers(const std::filesystem::path& path, const LogOptions& options);

/// Derives findings from the measurements, warnings first. diagnose() calls this function.
std::vector<Finding> judge(const LogDiagnosis& diagnosis);

/// Facts about the log, one per line.
std::vector<std::string> describe_facts(const LogDiagnosis& diagnosis);

/// Table of the beam angle study with one convention per line; the best is marked. Empty without a study.
std::vector<std::string> describe_beam_angles(const BeamAngleStudy& study);

/// Table of the study of the sweep direction with one order of the beams per line; the best is marked. Empty
/// without pairs of scans.
std::vector<std::string> describe_sweep_direction(const SweepDirectionStudy& study);

/// Returns why mapping refuses the log, or ends before its last scan: one sentence; empty if it does not.
std::string refusal_of(const LogDiagnosis& diagnosis);

/// Judgement in one line: "ready to map", "maps with 2 warnings" or "cannot be mapped".
std::string verdict_of(const LogDiagnosis& diagnosis);

/// Lines with facts, beam angles, findings with their remedies and the verdict, as `psi-slam check` prints
/// them.
std::vector<std::string> describe(const LogDiagnosis& diagnosis);

/// All measurements and findings as JSON, in SI units with the unit in each key.
nlohmann::ordered_json to_json(const LogDiagnosis& diagnosis);

}  // namespace psi_slam
