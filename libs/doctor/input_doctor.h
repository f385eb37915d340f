// SPDX-License-Identifier: BSD-3-Clause
// Looks a log over before anything maps it: what it holds, and what looks wrong, each with its remedy.
// Odometry is judged by the scans themselves, a few seconds' worth of them spread over the whole log.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "doctor/beam_angle_study.h"
#include "doctor/log_facts.h"
#include "doctor/odometry_check.h"
#include "doctor/odometry_faults.h"
#include "doctor/pair_alignment.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

enum class Severity : std::uint8_t {
  kNote,     ///< good to know; the log can be mapped as it is
  kWarning,  ///< something is wrong, and the map will suffer
};

/// One thing to know about a log.
struct Finding {
  std::string code;  ///< for programs: "mirrored_scan", "time_backwards", ...
  Severity severity = Severity::kNote;
  std::string sentence;
  std::string
      remedy;  ///< an .ini line ("log.mirrored = true") or what to do; empty when there is nothing to do
};

/// Everything that was measured, and what follows from it.
struct LogDiagnosis {
  std::filesystem::path path;
  LogFacts facts;
  LogOptions options;                               ///< those under which the log was judged
  BeamAngles used_beam_angles = BeamAngles::kAuto;  ///< kAuto when the log states its angles
  OdometryAgreement odometry;
  bool odometry_is_sound = false;  ///< its units and signs are right; only then the rest is filled
  LostReversals reversals;
  OdometryJumps jumps;
  RevisitAgreement revisits;
  std::optional<LaserMountEstimate> mount;
  BeamAngleStudy beam_angles;
  std::vector<FrameMark> marks;  ///< of all frames, for the times of findings
  std::vector<Finding> findings;
};

/// Reads the whole log (`options.every_nth_scan` and `sweep_time_s` are not applied) and fills everything. A
/// log that breaks off is judged up to there. Throws UserError when not even its first scan can be read.
LogDiagnosis diagnose(const std::filesystem::path& path, const LogOptions& options = {});

/// What follows from the measurements: the warnings first, then the notes. `diagnose` has called it.
std::vector<Finding> judge(const LogDiagnosis& diagnosis);

}  // namespace psi_slam
