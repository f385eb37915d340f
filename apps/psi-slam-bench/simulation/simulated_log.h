// SPDX-License-Identifier: BSD-3-Clause
// A log of a robot in a simulated building, made scan by scan as it is read, with the truth of each scan.
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

/// A laser beside the first one: it scans at the same rate, that much later.
struct FurtherLaser {
  ScanSimulatorOptions scan;
  double delay_s = 0;  ///< not negative, and less than the time between scans
};

/// Each part has a seed of its own; simulated_log_options() sets them all.
struct SimulatedLogOptions {
  FloorPlanOptions plan;
  RobotPathOptions path;
  ScanSimulatorOptions scan;
  WheelOdometryOptions odometry;
  /// Further lasers of the robot, whose scans come as companions of the first laser's.
  std::vector<FurtherLaser> further_lasers;
  std::size_t people = 0;
  std::uint64_t people_seed = 1;
};

/// A drive of that length through a building in which it comes by every place about three times, with the one
/// seed for all parts.
SimulatedLogOptions simulated_log_options(double path_m, std::uint64_t seed);

class SimulatedLog : public FrameSource {
 public:
  /// Throws std::invalid_argument when a laser's delay is out of bounds.
  explicit SimulatedLog(const SimulatedLogOptions& options);
  SimulatedLog(const SimulatedLog&) = delete;
  SimulatedLog& operator=(const SimulatedLog&) = delete;

  std::optional<Frame> next() override;
  /// By metres of the path.
  double progress() const override;

  /// Where the robot truly was at the frame that next() gave last, in the plan.
  const mrpt::math::TPose2D& world_T_robot() const { return now_.world_T_robot; }
  double travelled_m() const { return now_.travelled_m; }
  const FloorPlan& plan() const { return plan_; }

 private:
  /// Where the robot is when the first laser scans.
  struct Stop {
    PathPose path;
    mrpt::math::TPose2D odom_T_robot;
  };

  std::optional<Stop> drive_on();
  CompanionScan scan_between(std::size_t laser, const Stop& now, const Stop& next);

  SimulatedLogOptions options_;
  FloorPlan plan_;
  RobotPath path_;
  ScanSimulator scanner_;
  std::deque<ScanSimulator> further_scanners_;
  WheelOdometry odometry_;
  WalkingPeople people_;
  PathPose now_;
  std::optional<Stop> last_stop_;  ///< that the path has come to
  std::optional<Stop> ahead_;      ///< read already, for lasers that scan a little later
  std::size_t frames_ = 0;
};

}  // namespace psi_slam
