// SPDX-License-Identifier: BSD-3-Clause
// Estimates the bearings of the beams for a log that does not state them: compares all conventions on scans
// between which the robot turned. There are three kinds of evidence:
//
// - The distance of points to walls after alignment. It reveals a wrong kSkipZero, which bends the scan in
//   its middle. It does not reveal a wrong step between beams, which scales bearings and turns alike.
// - A full turn on the spot, whose alignments must sum to 360 degrees. Only full turns measure the step.
// - The direction of driving. A shift of all bearings acts like a rotated laser, and only driving straight
//   shows the heading of the laser. The study chooses, among the conventions that the other evidence does not
//   rule out, the one whose laser heading is closest to the stated heading.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "logs/doctor/scan_sampling.h"
#include "logs/frames/laser_readings.h"

namespace psi_slam {

/// One convention and its evidence.
struct BeamAngleFit {
  BeamAngles angles = BeamAngles::kLeftOpen;
  double mean_distance_m = 0;      ///< mean distance from points to walls, over all pairs of scans
  double worse_by_m = 0;           ///< mean_distance_m minus the smallest of all conventions
  double significance = 0;         ///< worse_by_m in standard errors
  double full_turn_error_rad = 0;  ///< mean excess of full turns over 360 degrees; 0 without full turns
  double laser_heading_rad = 0;    ///< laser heading under this convention minus the stated one; 0 if unknown
  bool ruled_out_by_walls = false;
  bool ruled_out_by_turns = false;
};

struct BeamAngleStudy {
  std::size_t pairs = 0;  ///< pairs of scans that every convention aligned reliably
  std::size_t full_turns = 0;
  bool knows_heading = false;      ///< whether laser_heading_rad is set
  std::vector<BeamAngleFit> fits;  ///< one for each possible convention; empty with fewer than 20 pairs
  BeamAngles best = BeamAngles::kAuto;
};

/// Frames that a study compares.
struct BeamAngleEvidence {
  std::vector<FramePair> turning_pairs;  ///< frames between which the robot turned by 10 to 45 degrees
  std::vector<std::vector<std::size_t>> full_turns;
};

/// Selects the frames for a study, by their odometry. The units and signs of odometry must be right.
BeamAngleEvidence choose_beam_angle_evidence(const std::vector<FrameMark>& marks);

/// Compares the conventions. `library` must hold the frames of `evidence`, read with the bearings `used_rad`.
/// `laser_heading_rad`, if known, is the laser heading under these bearings minus the stated one.
BeamAngleStudy study_beam_angles(const std::vector<FrameMark>& marks, const BeamAngleEvidence& evidence,
                                 const ScanLibrary& library, const std::vector<float>& used_rad,
                                 double field_of_view_rad, std::optional<double> laser_heading_rad);

}  // namespace psi_slam
