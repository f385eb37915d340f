// SPDX-License-Identifier: BSD-3-Clause
// What moves in a simulated building: people in the corridors, an operator beside the robot, carts that are
// parked elsewhere later, and doors of rooms that open and close.
#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "simulation/floor_plan.h"
#include "simulation/simulated_log.h"

namespace psi_slam {

struct TrafficOptions {
  std::uint64_t seed = 1;
  double duration_s = 0;   ///< carts and doors change after a quarter or three quarters of this time
  std::size_t people = 0;  ///< people who walk up and down the corridors
  std::size_t carts = 0;   ///< carts beside the walls of corridors, each there in three quarters of the time
  bool doors = false;      ///< whether each door of a room is closed in three quarters of the time
  bool has_operator = false;  ///< whether a person walks beside the robot, half a metre ahead
};

/// Everything that moves, at one moment: people by their centres, other things by their outlines.
struct TrafficNow {
  std::vector<mrpt::math::TPoint2D> people;
  std::vector<PlanSegment> things;
};

class Traffic {
 public:
  Traffic(const FloorPlan& plan, const TrafficOptions& options);

  /// Returns what moves at a time since the start, with the robot at a pose. Doors are open and carts gone
  /// within 1.5 m of the robot.
  TrafficNow at(double time_s, const mrpt::math::TPose2D& world_T_robot) const;

 private:
  /// Outline of a thing that leaves after three quarters of the time or comes after one quarter.
  struct Thing {
    std::vector<PlanSegment> outline;
    bool leaves = false;
  };

  TrafficOptions options_;
  WalkingPeople people_;
  std::vector<Thing> things_;
};

}  // namespace psi_slam
