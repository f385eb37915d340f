// SPDX-License-Identifier: BSD-3-Clause
// Which bearings a log's beams have, where it does not say: every convention is tried on scans between which
// the robot turned. What each kind of evidence can and cannot tell:
//
// - The distance of points to walls after alignment shows a kink between the halves of the scan (kSkipZero):
// walls on
//   one side meet those on the other. It is blind to the size of the steps: turning stretched scans stretches
//   the turn.
// - A full turn on the spot must add up to 360 degrees; this measures the size of the steps, and nothing else
// here does.
// - A shift of all bearings is the same as a laser that looks to the side, so only driving ahead shows it:
// among what
//   remains, the convention under which the laser looks most nearly where it is said to look is taken.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "doctor/scan_sampling.h"
#include "frames/beam_angles.h"

namespace psi_slam {

/// One convention and how it fares.
struct BeamAngleFit {
  BeamAngles angles = BeamAngles::kLeftOpen;
  double mean_distance_m = 0;      ///< of points to walls over all pairs
  double worse_by_m = 0;           ///< than the convention with the least, pair by pair
  double significance = 0;         ///< worse_by_m in standard errors
  double full_turn_error_rad = 0;  ///< mean excess over 360 degrees; 0 without full turns
  double laser_heading_rad = 0;    ///< where the laser looks beside where it is said to look; 0 when unknown
  bool ruled_out_by_walls = false;
  bool ruled_out_by_turns = false;
};

struct BeamAngleStudy {
  std::size_t pairs = 0;  ///< that every convention aligned reliably
  std::size_t full_turns = 0;
  bool knows_heading = false;      ///< laser_heading_rad is filled
  std::vector<BeamAngleFit> fits;  ///< empty when there were too few pairs
  BeamAngles best = BeamAngles::kAuto;
};

/// What a study compares; `library` holds these frames.
struct BeamAngleEvidence {
  std::vector<FramePair> turning_pairs;  ///< 10 ... 45 degrees apart
  std::vector<std::vector<std::size_t>> full_turns;
};

/// Chooses the evidence by odometry, which must be sound.
BeamAngleEvidence choose_beam_angle_evidence(const std::vector<FrameMark>& marks);

/// `used` are the bearings that the scans of the library have, those of the first scan; `laser_heading_rad`,
/// if known, is where the laser looks with them, beside where it is said to look.
BeamAngleStudy study_beam_angles(const std::vector<FrameMark>& marks, const BeamAngleEvidence& evidence,
                                 const ScanLibrary& library, const std::vector<float>& used_rad,
                                 double field_of_view_rad, std::optional<double> laser_heading_rad);

}  // namespace psi_slam
