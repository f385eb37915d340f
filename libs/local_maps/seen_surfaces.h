// SPDX-License-Identifier: BSD-3-Clause
// Decides where a scan saw one surface between two neighbouring beams. At 20 m, the beams of a usual laser
// hit a wall every 10 to 35 cm, so that a map of the hits alone is a row of dots: the next scan falls between
// them and hardly scores. A local map draws the wall between such beams too.
#pragma once

#include <vector>

#include "psi_slam/frame.h"

namespace psi_slam {

/// For each beam: whether its end and the end of the beam before lie on one surface. Both must be returns of
/// at most `max_range_m`; the surface must continue straight to the end of a third neighbouring beam; and it
/// must not be seen at a grazing angle, where beams pass over door recesses.
std::vector<bool> ends_on_one_surface(const LaserScan& scan, double max_range_m);

}  // namespace psi_slam
