// SPDX-License-Identifier: BSD-3-Clause
// Makes maps of simulated buildings with one known fault each, and measures their true errors.
#pragma once

#include <mrpt/math/TPoint2D.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "psi_slam/mapping_result.h"

namespace psi_slam {

enum class MapFault {
  kNone,
  kFalseLoop,   ///< one false loop that joins two random places, with full weight in the graph
  kNearbyLoop,  ///< one true loop, moved by 1 to 3 m
  kLoopGroup,   ///< several false loops that agree with each other
  kNoLoops,     ///< loop closing off, noisy odometry, few scans of short range
  kSlip,        ///< the wheels slip while the laser is blind; loop closing off
  kCarried,     ///< robot carried elsewhere while it was off; odometry goes on as if it had stood still
  kThinned,     ///< few scans and noisy odometry
};
inline constexpr std::array<MapFault, 8> kMapFaults{
    MapFault::kNone,    MapFault::kFalseLoop, MapFault::kNearbyLoop, MapFault::kLoopGroup,
    MapFault::kNoLoops, MapFault::kSlip,      MapFault::kCarried,    MapFault::kThinned};

/// Name of a fault: "none", "false loop", ...
std::string name_of(MapFault fault);

/// Returns whether a fault has one place: a false loop or a place of the path.
bool has_one_place(MapFault fault);

struct FaultyMap {
  MapFault fault = MapFault::kNone;
  std::uint64_t seed = 1;
  MappingResult result;
  double error_m = 0;                        ///< mean error of the positions, after the best rigid alignment
  std::vector<mrpt::math::TPoint2D> places;  ///< places of the fault in the map; empty without one place
};

/// Mean distance between two paths of the same frames after the rigid alignment that minimises the sum of
/// squared distances.
double aligned_error_m(const std::vector<mrpt::math::TPose2D>& path,
                       const std::vector<mrpt::math::TPose2D>& truth);

/// Simulates a building and a run of path_m to 1.75 path_m, makes a map with each kind of fault, and hands
/// each to `take`. Seeds draw building, path, people, noise and faults.
void make_faulty_maps(std::uint64_t seed, double path_m, const std::function<void(FaultyMap&&)>& take);

}  // namespace psi_slam
