// SPDX-License-Identifier: BSD-3-Clause
// Finds a field of view that a log states wrongly by a factor of two, such as 90 degrees of 180. There are
// two kinds of evidence:
//
// - Turns. A wrong step between beams scales bearings and turns alike: the scans turn half or twice as far as
//   odometry, whose turns may be wrong themselves.
// - Straight motion. Wrong bearings bend walls, which do not fit each other if the robot moves along them.
#pragma once

#include <cstddef>
#include <vector>

#include "logs/doctor/scan_sampling.h"

namespace psi_slam {

/// A field of view and its evidence.
struct FieldOfViewFit {
  double field_of_view_rad = 0;
  double mean_distance_m = 0;  ///< mean distance from points to walls after straight motion
  double turn_share = 0;       ///< fraction of the turns that are those of odometry
};

struct FieldOfViewStudy {
  std::size_t turns = 0;           ///< pairs of scans between which the robot turned
  std::size_t straight_pairs = 0;  ///< pairs of scans between which it moved straight
  std::vector<FieldOfViewFit>
      fits;  ///< the stated field of view, and its double and half if they are possible
  /// Index of the field of view that fits better than the stated one by both kinds of evidence; 0: none does.
  std::size_t best = 0;

  bool finds_fault() const { return best != 0; }
};

/// Frames that a study compares.
struct FieldOfViewEvidence {
  std::vector<FramePair> turning_pairs;  ///< between their frames, the robot turned by 6 to 45 degrees
  /// Between their frames, the robot moved by 0.5 m and turned by less than 6 degrees.
  std::vector<FramePair> straight_pairs;
};

/// Selects the frames for a study by odometry.
FieldOfViewEvidence choose_field_of_view_evidence(const std::vector<FrameMark>& marks);

/// Compares the stated field of view with its double and half. `library` must hold the frames of `evidence`,
/// with the bearings that the log states. The study is empty if a kind has fewer than 15 pairs, or if the
/// bearings are not symmetric, which log.field_of_view_deg cannot correct.
FieldOfViewStudy study_field_of_view(const std::vector<FrameMark>& marks, const FieldOfViewEvidence& evidence,
                                     const ScanLibrary& library);

}  // namespace psi_slam
