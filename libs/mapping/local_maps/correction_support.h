// SPDX-License-Identifier: BSD-3-Clause
// Measures whether more than one small object of the scan supports a match's correction of the odometry. A
// person walking near the robot can cover more points of the scan than all doors of a corridor.
#pragma once

#include <mrpt/math/TPose2D.h>

#include "matching/scan_points.h"
#include "matching/score_grid.h"

namespace psi_slam {

/// Radius of the spot that scores_without_best_spot() excludes, in metres: about the size of a person.
inline constexpr double kPersonReach_m = 0.4;

/// Mean scores of the scan's points at two poses, in [0, 1].
struct CorrectionScores {
  double matched = 0;  ///< mean score at the matched pose
  double held = 0;     ///< mean score at the pose kept close to odometry
};

/// Returns the mean score of the scan's points at a pose in the frame of `grid`. Zero without points.
double mean_score(const ScoreGrid& grid, const ScanPoints& scan, const mrpt::math::TPose2D& pose);

/// Returns the mean scores at two poses in the frame of `grid`. Excludes the points within kPersonReach_m of
/// one point, chosen so that the match raises their total score most. Returns zeros if no points are left.
CorrectionScores scores_without_best_spot(const ScoreGrid& grid, const ScanPoints& scan,
                                          const mrpt::math::TPose2D& matched,
                                          const mrpt::math::TPose2D& held);

}  // namespace psi_slam
