// SPDX-License-Identifier: BSD-3-Clause
// The search window of a scan match, equations 7 and 8 of the paper:
//
//     r_theta = acos(1 - r_t^2 / (2 d_max^2)),   n_x = ceil(W_x / r_t),   n_theta = ceil(W_theta / r_theta)
//
// W are the half-widths around the predicted pose. The brackets of the paper are read as ceilings, so the
// cells cover W.
#pragma once

#include "psi_slam/matching.h"

namespace psi_slam {

/// Steps that cover a SearchExtent. Column c is at x0 + (c - n_x) r_t with c = 0 .. 2 n_x, where x0 is the
/// predicted position. Exhaustive searches include both borders; the chromosome of equation 9 has no last
/// column.
struct SearchWindow {
  double linear_step_m = 0;     ///< r_t, the score grid's resolution
  double angular_step_rad = 0;  ///< r_theta: turn that moves the farthest point by one cell
  int n_x = 0;
  int n_y = 0;
  int n_theta = 0;

  /// Number of poses of an exhaustive search of the window.
  double poses() const { return (2.0 * n_x + 1) * (2.0 * n_y + 1) * (2.0 * n_theta + 1); }
};

/// Computes equations 7 and 8. `farthest_point_m` is d_max, the largest distance of a point from the robot.
/// Throws std::invalid_argument if a half-width or the resolution is not positive and finite, or if a
/// half-width needs more than a million steps. Also throws it if d_max is at most half the resolution,
/// because the arc cosine of equation 7 is then undefined.
SearchWindow make_search_window(const SearchExtent& extent, double resolution_m, double farthest_point_m);

}  // namespace psi_slam
