// SPDX-License-Identifier: BSD-3-Clause
// A drive through a floor plan: rings are closed, corridors driven both ways, rooms entered and left. The
// robot follows a carrot on the line from place to place, slows down in curves, and turns on the spot where
// it must go back; nothing of the drive is kept.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstdint>
#include <memory>
#include <optional>

#include "simulation/floor_plan.h"

namespace psi_slam {

struct RobotPathOptions {
  std::uint64_t seed = 1;
  double path_m = 150;
  double scan_rate_hz = 8;
  double max_speed_m_s = 0.9;
  double max_turn_rad_s = 1.0;
  double max_acceleration_m_s2 = 0.6;
  double weave_m = 0.1;  ///< how far the robot strays from the middle of its way
};

/// Where the robot truly is when it scans.
struct PathPose {
  double time_s = 0;
  double travelled_m = 0;
  mrpt::math::TPose2D world_T_robot;
};

class RobotPath {
 public:
  /// The plan outlives the path.
  RobotPath(const FloorPlan& plan, const RobotPathOptions& options);
  ~RobotPath();
  RobotPath(RobotPath&&) noexcept;

  /// The pose of the next scan; none when the path is long enough.
  std::optional<PathPose> next();

 private:
  class Carrot;

  void drive_on(double duration_s);

  RobotPathOptions options_;
  std::unique_ptr<Carrot> carrot_;
  PathPose now_;
  double speed_m_s_ = 0;
  bool started_ = false;
};

}  // namespace psi_slam
