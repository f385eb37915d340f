// SPDX-License-Identifier: BSD-3-Clause
// A log of a robot in a simulated building, computed scan by scan, with the true pose of each scan.
#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "base/degrees.h"
#include "psi_slam/frame_source.h"
#include "simulation/floor_plan.h"
#include "simulation/robot_path.h"
#include "simulation/scan_simulator.h"
#include "simulation/simulation_random.h"

namespace psi_slam {

/// People who walk up and down the corridors. Their positions depend only on the time.
class WalkingPeople {
 public:
  WalkingPeople(const FloorPlan& plan, std::size_t count, std::uint64_t seed);

  /// Centres of the people in the plan, in metres.
  std::vector<mrpt::math::TPoint2D> at(double time_s) const;

 private:
  /// A person who walks back and forth between two points.
  struct Person {
    mrpt::math::TPoint2D from;
    mrpt::math::TPoint2D to;
    double speed_m_s = 1;
    double start_m = 0;  ///< distance walked at time 0
  };
  std::vector<Person> people_;
};

struct WheelOdometryOptions {
  std::uint64_t seed = 1;
  double length_scale = 1.01;  ///< factor of distances; above 1 for wheels smaller than assumed
  double turn_scale = 1.01;    ///< factor of rotations; above 1 for wheels farther apart than assumed
  /// Standard deviation of the distance after 1 m; twice as large after 4 m.
  double sigma_m_per_root_m = 0.01;
  /// Standard deviations of the heading after 1 m and after a rotation by 1 rad.
  double sigma_rad_per_root_m = radians_from_degrees(0.4L);
  double sigma_rad_per_root_rad = radians_from_degrees(1.0L);
};

/// Simulated wheel odometry. Random errors are random walks: their variances grow in proportion to distance
/// and rotation, independent of the step size. Scale errors are constant.
class WheelOdometry {
 public:
  explicit WheelOdometry(const WheelOdometryOptions& options)
      : options_(options), random_(options.seed, SimulationRandom::Stream::kOdometry) {}

  /// Pose odom_T_robot after a motion `before_T_now` since the last call. Starts at the origin.
  mrpt::math::TPose2D move(const mrpt::math::TPose2D& before_T_now);

 private:
  WheelOdometryOptions options_;
  SimulationRandom random_;
  mrpt::math::TPose2D odom_T_robot_{0, 0, 0};
};

/// A further laser, which scans at the rate of the first laser with a delay.
struct FurtherLaser {
  ScanSimulatorOptions scan;
  double delay_s = 0;  ///< in [0, time between scans)
};

/// Options of a simulated log. Each part has its own seed; simulated_log_options() sets all seeds.
struct SimulatedLogOptions {
  FloorPlanOptions plan;
  RobotPathOptions path;
  ScanSimulatorOptions scan;
  WheelOdometryOptions odometry;
  /// Lasers whose scans are companions of the scans of the first laser.
  std::vector<FurtherLaser> further_lasers;
  std::size_t people = 0;
  std::uint64_t people_seed = 1;
};

inline constexpr double kVisits =
    3;  ///< length of the path divided by the least total length of the corridors

/// Options of a run with a path of `path_m` metres, about three times as long as the corridors of its
/// building. All parts get the same seed.
SimulatedLogOptions simulated_log_options(double path_m, std::uint64_t seed);

class SimulatedLog : public FrameSource {
 public:
  /// Throws std::invalid_argument if the delay of a laser is out of bounds.
  explicit SimulatedLog(const SimulatedLogOptions& options);
  SimulatedLog(const SimulatedLog&) = delete;
  SimulatedLog& operator=(const SimulatedLog&) = delete;

  std::optional<Frame> next() override;
  /// Share of the path that the robot has travelled, in [0, 1].
  double progress() const override;

  /// True pose of the robot in the plan at the frame that next() returned last.
  const mrpt::math::TPose2D& world_T_robot() const { return now_.world_T_robot; }
  double travelled_m() const { return now_.travelled_m; }
  const FloorPlan& plan() const { return plan_; }

 private:
  /// True pose and odometry of the robot at a scan of the first laser.
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
