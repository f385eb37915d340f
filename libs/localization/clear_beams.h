// SPDX-License-Identifier: BSD-3-Clause
// Tests whether a scan could have been taken at a pose of a map: its beams must not pass through walls. It is
// not enough that the ends of the beams lie on walls, since most ends find some wall in a large building.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>

#include "matching/scan_points.h"
#include "matching/score_grid.h"

namespace psi_slam {

struct ClearBeams {
  std::size_t beams = 0;
  std::size_t clear = 0;  ///< beams that meet no wall before their end
  double share() const { return beams == 0 ? 0 : static_cast<double>(clear) / static_cast<double>(beams); }
};

/// Follows all beams of the scan. A wall near the end of a beam counts as the surface that the beam hit.
ClearBeams clear_beams(const ScoreGrid& map, const ScanPoints& scan, const mrpt::math::TPose2D& map_T_robot);

}  // namespace psi_slam
