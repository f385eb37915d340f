// SPDX-License-Identifier: BSD-3-Clause
// What a laser sees of a floor plan: MRPT's own simulator of scans on an occupancy grid, into which the plan
// around the robot is painted, with range noise, glass, people and lost returns on top.
//
// Beams step through the grid cell by cell, so that without noise a range is as exact as its resolution.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstdint>
#include <vector>

#include "psi_slam/frame.h"
#include "simulation/floor_plan.h"
#include "simulation/simulation_random.h"

namespace psi_slam {

struct ScanSimulatorOptions {
  std::uint64_t seed = 1;
  std::size_t beams = 181;
  double field_of_view_rad = M_PI;  ///< in (0, 2 pi]
  double max_range_m = 30;
  mrpt::math::TPose2D robot_T_laser{0.1, 0, 0};
  double resolution_m = 0.02;       ///< of the grid that is painted
  double noise_m = 0.01;            ///< standard deviation of a range, not negative
  double dropout_share = 0.005;     ///< of the beams that return nothing for no reason
  double glass_return_share = 0.3;  ///< of the beams that meet glass: it returns them
  double glass_loss_share = 0.2;    ///< of the beams that meet glass: they never return; the others pass
};

class ScanSimulator {
 public:
  /// The plan outlives the simulator. Throws std::invalid_argument for fewer than two beams, a field of view,
  /// noise or share out of bounds, a resolution that is not positive, a range that is not longer than it, and
  /// what is not finite.
  ScanSimulator(const FloorPlan& plan, const ScanSimulatorOptions& options);

  /// The scan from a pose; `index` seeds its noise. A beam without return is NaN.
  LaserScan scan(const mrpt::math::TPose2D& world_T_robot, const std::vector<mrpt::math::TPoint2D>& people,
                 std::uint64_t index);

 private:
  void paint_around(const mrpt::math::TPoint2D& middle);
  void paint(const PlanSegment& segment);
  double range_m(const mrpt::math::TPose2D& ray, float least_free) const;
  double plan_range_m(const mrpt::math::TPose2D& ray, SimulationRandom& random) const;

  const FloorPlan& plan_;
  ScanSimulatorOptions options_;
  BeamBearings bearings_rad_;
  mrpt::maps::COccupancyGridMap2D grid_;
  mrpt::math::TPoint2D painted_;  ///< the middle of the grid
  bool any_painted_ = false;
  bool any_glass_ = false;  ///< in the grid
};

}  // namespace psi_slam
