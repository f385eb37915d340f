// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPoint2D.h>

namespace psi_slam {

/// What an edit of a loop would change in a finished map.
struct EditEffect {
  double moved_m = 0;            ///< largest motion of a node
  mrpt::math::TPoint2D at;       ///< place of that node in the map, before the edit
  double scan_s = 0;             ///< time of the scan that the edit names, since the start of its run
  mrpt::math::TPoint2D scan_at;  ///< place of that scan in the map, before the edit
};

}  // namespace psi_slam
