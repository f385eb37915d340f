// SPDX-License-Identifier: BSD-3-Clause
// Directions of the beams of a laser.
#pragma once

#include <mrpt/math/TPoint2D.h>

#include <memory>
#include <vector>

#include "psi_slam/frame.h"

namespace psi_slam {

/// Unit vectors, one for each beam.
using BeamDirections = std::shared_ptr<const std::vector<mrpt::math::TPoint2D>>;

/// Returns the directions of the beams with these bearings, in the laser's frame. Returns an empty vector if
/// `bearings_rad` is null. Each thread keeps the directions of its last eight lasers, whose scans share their
/// bearings.
BeamDirections beam_directions(const BeamBearings& bearings_rad);

}  // namespace psi_slam
