// SPDX-License-Identifier: BSD-3-Clause
// Path of a robot through a floor plan: it closes rings, uses corridors in both directions and enters rooms.
// The robot follows a point (the carrot) that moves along the lines between places. It slows down in curves
// and turns on the spot to go back. Poses are computed one by one and not stored.
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
  double weave_m = 0.1;  ///< largest deviation from the line between places
};

/// True pose of the robot at the time of a scan.
struct PathPose {
  double time_s = 0;
  double travelled_m = 0;
  mrpt::math::TPose2D world_T_robot;
};

class RobotPath {
 public:
  /// The plan must outlive the path.
  RobotPath(const FloorPlan& plan, const RobotPathOptions& options);
  ~RobotPath();
  RobotPath(RobotPath&&) noexcept;

  /// Pose at the next scan; empty at the end of the path.
  std::optional<PathPose> next();

 private:
  class Carrot;

  void advance(double duration_s);

  RobotPathOptions options_;
  std::unique_ptr<Carrot> carrot_;
  PathPose now_;
  double speed_m_s_ = 0;
  bool started_ = false;
};

}  // namespace psi_slam
