// SPDX-License-Identifier: BSD-3-Clause
// Runs through simulated buildings with the true pose of each scan, and maps drawn at the true poses. All
// poses are in the frame of the floor plan.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <cmath>
#include <vector>

#include "localization/localizer_options.h"
#include "localization/reference_map.h"
#include "logs/frames/pose_operations.h"
#include "psi_slam/grid_map.h"
#include "psi_slam/localizer.h"
#include "simulation/simulated_log.h"

namespace psi_slam {

struct TrueRun {
  std::vector<Frame> frames;
  std::vector<mrpt::math::TPose2D> world_T_robot;  ///< true pose of the robot at each frame
};

/// Options of the floor plan of a building.
inline FloorPlanOptions plan_options(std::uint64_t plan) {
  FloorPlanOptions options = simulated_log_options(1, 1).plan;
  options.seed = plan;
  options.corridors_m = 90;
  return options;
}

/// Simulates a run through a building. `plan` is the seed of the building, `run` the seed of path and noise.
inline TrueRun run_through(std::uint64_t plan, std::uint64_t run, double path_m) {
  SimulatedLogOptions options = simulated_log_options(path_m, run);
  options.plan = plan_options(plan);
  options.path.scan_rate_hz = 4;
  SimulatedLog log(options);
  TrueRun result;
  while (std::optional<Frame> frame = log.next()) {
    result.frames.push_back(*std::move(frame));
    result.world_T_robot.push_back(log.world_T_robot());
  }
  return result;
}

inline mrpt::maps::COccupancyGridMap2D map_of(const TrueRun& run) {
  return *draw_grid_map(run.frames, run.world_T_robot);
}

inline std::vector<LocalizationStep> localize(Localizer& localizer, const std::vector<Frame>& frames) {
  std::vector<LocalizationStep> steps;
  for (const Frame& frame : frames) steps.push_back(localizer.add(frame));
  return steps;
}

inline ReferenceMap reference_of(const mrpt::maps::COccupancyGridMap2D& grid,
                                 const LocalizerOptions& options = {}) {
  return make_reference_map(grid, options.search.resolution_m, options.search.smoothing_sigma_m);
}

}  // namespace psi_slam
