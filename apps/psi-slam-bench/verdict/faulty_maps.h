// SPDX-License-Identifier: BSD-3-Clause
// Makes maps of simulated buildings and of real logs with one known fault each, and measures their errors.
#pragma once

#include <mrpt/math/TPoint2D.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "batch/seeds.h"
#include "common/benchmark_logs.h"
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
  kPaused,      ///< robot switched off and on where it stood; odometry begins again at zero
};
inline constexpr std::array kMapFaults{MapFault::kNone,      MapFault::kFalseLoop, MapFault::kNearbyLoop,
                                       MapFault::kLoopGroup, MapFault::kNoLoops,   MapFault::kSlip,
                                       MapFault::kCarried,   MapFault::kThinned,   MapFault::kPaused};

/// Name of a fault: "none", "false loop", ...
std::string name_of(MapFault fault);

/// Returns whether a fault is one false loop or several.
bool is_false_loop(MapFault fault);

/// Returns whether a fault has one place: a false loop or a place of the path. A pause harms no map by
/// itself.
bool has_one_place(MapFault fault);

struct FaultyMap {
  std::string log;  ///< name of the log; empty for a simulated building
  MapFault fault = MapFault::kNone;
  std::uint64_t seed = 1;
  MappingResult result;
  double error_m = 0;  ///< true mean error of the positions, see mean_error_m()
  /// Mean distance of the scans from the true path of a simulated run, or from the map of the whole log,
  /// after the best rigid alignment. Relations are often short, and hide that parts of a map are displaced.
  double distance_m = 0;
  std::vector<mrpt::math::TPoint2D> places;  ///< places of the fault in the map; empty without one place
};

/// Simulates a building and a run of path_m to 1.75 path_m, makes a map without and with each kind of fault,
/// and hands each to `take`. Seeds draw building, path, people, noise and faults.
void make_simulated_maps(std::uint64_t seed, double path_m, const std::function<void(FaultyMap&&)>& take);

/// Maps a log with relations, makes a map with each kind of fault for each seed, and hands each to `take`.
/// The map without fault comes once, with the first seed. Seeds draw noise and faults. Throws UserError as
/// run_of_log().
void make_maps_of_log(const BenchmarkLog& log, const SeedRange& seeds,
                      const std::function<void(FaultyMap&&)>& take);

}  // namespace psi_slam
