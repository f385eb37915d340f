// SPDX-License-Identifier: BSD-3-Clause
// Simulates laser scans in a floor plan. Paints the plan around the robot into an occupancy grid, uses MRPT's
// simulation of beams, and adds range noise, glass, people and lost returns. Without noise, ranges are as
// exact as the resolution of the grid.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstdint>
#include <vector>

#include "psi_slam/frame.h"
#include "simulation/floor_plan.h"
#include "simulation/simulation_random.h"

namespace psi_slam {

inline constexpr double kPersonRadius_m = 0.2;

struct ScanSimulatorOptions {
  std::uint64_t seed = 1;
  std::size_t beams = 181;
  double field_of_view_rad = M_PI;  ///< in (0, 2 pi]
  double max_range_m = 30;
  mrpt::math::TPose2D robot_T_laser{0.1, 0, 0};
  double resolution_m = 0.02;       ///< cell size of the occupancy grid
  double noise_m = 0.01;            ///< standard deviation of a range, not negative
  double dropout_share = 0.005;     ///< share of beams without return, at random
  double glass_return_share = 0.3;  ///< share of the beams at glass that the glass returns
  double glass_loss_share = 0.2;    ///< share of the beams at glass without return; the rest pass through
};

class ScanSimulator {
 public:
  /// The plan must outlive the simulator. Throws std::invalid_argument for fewer than two beams, a field of
  /// view, noise or share out of bounds, a resolution that is not positive, a range not above the resolution,
  /// and infinite values.
  ScanSimulator(const FloorPlan& plan, const ScanSimulatorOptions& options);

  /// Simulates a scan of a robot at a pose among people, whose centres are points in the plan, and among
  /// `things` that are not in the plan. `index` seeds the noise: all beams that neither people nor things
  /// stop have the same ranges without them. The range of a beam without return is infinite.
  LaserScan scan(const mrpt::math::TPose2D& world_T_robot, const std::vector<mrpt::math::TPoint2D>& people,
                 std::uint64_t index, const std::vector<PlanSegment>& things = {});

 private:
  void paint_around(const mrpt::math::TPoint2D& middle);
  void paint(const PlanSegment& segment);
  double range_m(const mrpt::math::TPose2D& ray, float least_free) const;
  double plan_range_m(const mrpt::math::TPose2D& ray, SimulationRandom& random) const;

  const FloorPlan& plan_;
  ScanSimulatorOptions options_;
  BeamBearings bearings_rad_;
  mrpt::maps::COccupancyGridMap2D grid_;
  mrpt::math::TPoint2D painted_;  ///< centre of the grid
  bool any_painted_ = false;
  bool any_glass_ = false;  ///< true if the grid has glass
};

}  // namespace psi_slam
