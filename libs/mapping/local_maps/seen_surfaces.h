// SPDX-License-Identifier: BSD-3-Clause
// Decides between which neighbouring beams a scan saw a continuous surface. At 20 m, the beams of a usual
// laser hit a wall every 10 to 35 cm. If a local map drew only these hits, the points of the next scan would
// fall between them and hardly score. A local map therefore draws the wall between such beams too.
#pragma once

#include <vector>

#include "psi_slam/frame.h"

namespace psi_slam {

/// Returns for each beam whether its end and the end of the beam before it lie on one surface. In a scan of a
/// full circle, the last beam comes before the first. Both must be returns of at most `max_range_m`, with
/// ends 5 cm to 2 m apart. The beams must be at least `min_spacing_m` apart at the nearer end. Otherwise
/// range noise, not the surface, determines the direction between the ends. The surface must continue
/// straight to the end of a third neighbouring beam. The beams must not meet the surface at a grazing angle,
/// because such beams can skip door recesses.
std::vector<bool> ends_on_one_surface(const LaserScan& scan, double max_range_m, double min_spacing_m);

}  // namespace psi_slam
