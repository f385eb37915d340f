// SPDX-License-Identifier: BSD-3-Clause
// A log of a robot in a simulated building, computed scan by scan, with the true pose of each scan.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "psi_slam/frame_source.h"
#include "simulation/floor_plan.h"
#include "simulation/robot_path.h"
#include "simulation/scan_simulator.h"
#include "simulation/walking_people.h"
#include "simulation/wheel_odometry.h"

namespace psi_slam {

/// A further laser, which scans at the same rate with a delay.
struct FurtherLaser {
  ScanSimulatorOptions scan;
  double delay_s = 0;  ///< in [0, time between scans)
};

/// Each part has its own seed; simulated_log_options() sets all of them.
struct SimulatedLogOptions {
  FloorPlanOptions plan;
  RobotPathOptions path;
  ScanSimulatorOptions scan;
  WheelOdometryOptions odometry;
  /// Their scans are companions of those of the first laser.
  std::vector<FurtherLaser> further_lasers;
  std::size_t people = 0;
  std::uint64_t people_seed = 1;
};

/// A run with this length of path, through a building whose places it visits about three times each. All
/// parts get the same seed.
SimulatedLogOptions simulated_log_options(double path_m, std::uint64_t seed);

class SimulatedLog : public FrameSource {
 public:
  /// Throws std::invalid_argument if the delay of a laser is out of bounds.
  explicit SimulatedLog(const SimulatedLogOptions& options);
  SimulatedLog(const SimulatedLog&) = delete;
  SimulatedLog& operator=(const SimulatedLog&) = delete;

  std::optional<Frame> next() override;
  /// Share of the path that is travelled.
  double progress() const override;

  /// True pose of the robot in the plan at the last frame of next().
  const mrpt::math::TPose2D& world_T_robot() const { return now_.world_T_robot; }
  double travelled_m() const { return now_.travelled_m; }
  const FloorPlan& plan() const { return plan_; }

 private:
  /// Poses of the robot at a scan of the first laser.
  struct Stop {
    PathPose path;
    mrpt::math::TPose2D odom_T_robot;
  };

  std::optional<Stop> next_stop();
  CompanionScan scan_between(std::size_t laser, const Stop& now, const Stop& next);

  SimulatedLogOptions options_;
  FloorPlan plan_;
  RobotPath path_;
  ScanSimulator scanner_;
  std::deque<ScanSimulator> further_scanners_;
  WheelOdometry odometry_;
  WalkingPeople people_;
  PathPose now_;
  std::optional<Stop> last_stop_;  ///< last stop taken from the path
  std::optional<Stop> ahead_;      ///< next stop, needed for lasers with a delay
  std::size_t frames_ = 0;
};

}  // namespace psi_slam
