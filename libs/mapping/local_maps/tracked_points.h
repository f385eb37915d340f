// SPDX-License-Identifier: BSD-3-Clause
// Points of a scan for the match with the local map that the front end draws.
//
// In a bare corridor, such a match must not hold the robot at the place of an earlier scan. Two properties of
// matching_points() would do so:
//  - Far ahead, neighbouring beams graze a wall metres apart, too far apart for a normal. The beams hit the
//    walls at the same ranges wherever the robot stands. If these points count as single objects, they fit
//    best at the place of the earlier scan.
//  - Noise that moves a point away from its wall also turns the normal of the point. The distance from the
//    wall then acts along the wall, for all points in the same direction.
#pragma once

#include "matching/scan_points.h"

namespace psi_slam {

/// Points of a scan to match, and those that tell apart poses along a wall.
struct TrackedPoints {
  ScanPoints matched;
  /// The points for comparing the scores of two poses. Empty: all points of `matched`.
  ScanPoints judged;
};

/// Returns the points of a scan with normals that do not tie the robot to an earlier place.
///  - A point with a normal gets the normal of its neighbours without the point itself, or none if these are
///    not on a straight line.
///  - A point without a normal gets that of the straightest grazed_wall() through four successive points that
///    hold the point. TrackedPoints::judged leaves out these points.
/// In a scan of a full circle, the first and the last point are not taken for neighbours.
/// If the normals of the scan are unknown, returns its points as they are.
TrackedPoints points_along_walls(const ScanPoints& scan);

}  // namespace psi_slam
