// SPDX-License-Identifier: BSD-3-Clause
// Measures whether more than one small object of the scan supports a match's correction of the odometry. A
// walking person near the robot can fill more of the scan than all doors of a corridor.
#pragma once

#include <mrpt/math/TPose2D.h>

#include "matching/scan_points.h"
#include "matching/score_grid.h"

namespace psi_slam {

/// Points within this distance of a point count as the same object.
inline constexpr double kPersonReach_m = 0.4;

/// Mean scores of the scan's points at two poses, in [0, 1].
struct CorrectionScores {
  double matched = 0;  ///< at the matched pose
  double held = 0;     ///< at the pose kept close to odometry
};

/// Returns mean scores without the points of one spot of radius kPersonReach_m: the spot that gains most from
/// the match.
CorrectionScores scores_without_best_spot(const ScoreGrid& grid, const ScanPoints& scan,
                                          const mrpt::math::TPose2D& matched,
                                          const mrpt::math::TPose2D& held);

}  // namespace psi_slam
