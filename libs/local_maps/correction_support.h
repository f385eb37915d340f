// SPDX-License-Identifier: BSD-3-Clause
// Whether a match's pull away from odometry has more behind it than one small thing, which may be a person
// who walks: near the robot a person fills more of the scan than all doors of a corridor do.
#pragma once

#include <mrpt/math/TPose2D.h>

#include "matching/scan_points.h"
#include "matching/score_grid.h"

namespace psi_slam {

/// What lies within this of one point is taken for one thing.
inline constexpr double kPersonReach_m = 0.4;

/// Mean scores at two poses, of the points that are counted.
struct PullScores {
  double matched = 0;
  double held = 0;
};

/// Of all points but those of the one spot, kPersonReach_m around a point, that speaks most for the match.
PullScores scores_without_best_spot(const ScoreGrid& grid, const ScanPoints& scan,
                                    const mrpt::math::TPose2D& matched, const mrpt::math::TPose2D& held);

}  // namespace psi_slam
