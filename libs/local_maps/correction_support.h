// SPDX-License-Identifier: BSD-3-Clause
// Tells whether a match's correction of the odometry has more support in the scan than one small object. That
// object can be a walking person, who fills more of the scan than all doors of a corridor if near the robot.
#pragma once

#include <mrpt/math/TPose2D.h>

#include "matching/scan_points.h"
#include "matching/score_grid.h"

namespace psi_slam {

/// Points within this distance of one point count as one object.
inline constexpr double kPersonReach_m = 0.4;

/// Mean scores of points at two poses, in [0, 1].
struct CorrectionScores {
  double matched = 0;
  double held = 0;  ///< at the pose held to odometry
};

/// Mean scores without the one spot, of radius kPersonReach_m, that supports the match most.
CorrectionScores scores_without_best_spot(const ScoreGrid& grid, const ScanPoints& scan,
                                          const mrpt::math::TPose2D& matched,
                                          const mrpt::math::TPose2D& held);

}  // namespace psi_slam
