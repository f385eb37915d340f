// SPDX-License-Identifier: BSD-3-Clause
// Whether a scan could have been taken at a pose of a map: its beams must not go through walls. That its ends
// lie on walls does not say so; in a building of many rooms most ends find a wall somewhere.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>

#include "matching/scan_points.h"
#include "matching/score_grid.h"

namespace psi_slam {

struct ClearBeams {
  std::size_t beams = 0;
  std::size_t clear = 0;  ///< of those, beams that meet no wall before their end
  double share() const { return beams == 0 ? 0 : static_cast<double>(clear) / static_cast<double>(beams); }
};

/// Walks along all beams of the scan. A wall that lies near the surface where the beam ends is that surface.
ClearBeams clear_beams(const ScoreGrid& map, const ScanPoints& scan, const mrpt::math::TPose2D& map_T_robot);

}  // namespace psi_slam
