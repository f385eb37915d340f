// SPDX-License-Identifier: BSD-3-Clause
// Brings a map up to date with a run in the same frame.
//
// A wall of the prior map has vanished where the run shows clear free space (clear_cells()) and no wall
// within the tolerance. A wall of the run has appeared where no remaining wall of the prior map is within the
// tolerance. All other walls of the run are walls of the prior map, seen anew: they are not drawn, so that
// errors of a run neither move nor thicken a wall, however often the map is extended.
//
// Three details:
// - Vanished cells that adjoin a wall that stands and reach less than 0.15 m are a hole that grazing beams
//   left. They stay.
// - Beside vanished cells, half the tolerance suffices, so that an opened door leaves no stubs at its jambs.
//   The other half is for errors: an object that was drawn beside a wall leaves nothing when it is taken
//   away.
// - A wall of the run that continues into space that the prior map does not show is drawn without a gap.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

namespace psi_slam {

/// Returns a map that covers both maps. Its cells are those of `run` where walls have vanished or appeared
/// and where `prior` shows nothing, except walls seen anew; elsewhere those of `prior`. Throws
/// std::invalid_argument if the maps have cells of different sizes.
mrpt::maps::COccupancyGridMap2D::Ptr extended_map(const mrpt::maps::COccupancyGridMap2D& prior,
                                                  const mrpt::maps::COccupancyGridMap2D& run,
                                                  double tolerance_m);

}  // namespace psi_slam
