// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/robot_path.h"

#include <gtest/gtest.h>

#include <map>
#include <utility>
#include <vector>

#include "plan_geometry.h"

namespace psi_slam {
namespace {

constexpr double kPath_m = 600;

struct TestPath {
  FloorPlan plan;
  RobotPathOptions options;
  std::vector<PathPose> poses;
};

TestPath path_of(std::uint64_t seed) {
  TestPath run;
  FloorPlanOptions plan;
  plan.seed = seed;
  plan.corridors_m = kPath_m / 4;
  run.plan = draw_floor_plan(plan);
  run.options.seed = seed;
  run.options.path_m = kPath_m;
  RobotPath path(run.plan, run.options);
  while (const std::optional<PathPose> pose = path.next()) run.poses.push_back(*pose);
  return run;
}

TEST(RobotPath, keeps_its_distance_from_walls) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const TestPath run = path_of(seed);
    for (std::size_t i = 1; i < run.poses.size(); ++i) {
      const mrpt::math::TPoint2D before(run.poses[i - 1].world_T_robot);
      const mrpt::math::TPoint2D now(run.poses[i].world_T_robot);
      for (const PlanSegment& wall : run.plan.segments)
        ASSERT_FALSE(cross_each_other(before, now, wall)) << "seed " << seed << ", pose " << i;
      ASSERT_GT(clearance_m(run.plan, now), 0.2) << "seed " << seed << ", pose " << i;
    }
  }
}

TEST(RobotPath, has_the_requested_length_and_limited_speed) {
  const TestPath run = path_of(1);
  const double period_s = 1 / run.options.scan_rate_hz;
  double length_m = 0;
  for (std::size_t i = 1; i < run.poses.size(); ++i) {
    const mrpt::math::TPose2D motion = run.poses[i].world_T_robot - run.poses[i - 1].world_T_robot;
    const double way_m = std::hypot(motion.x, motion.y);
    length_m += way_m;
    ASSERT_NEAR(run.poses[i].time_s - run.poses[i - 1].time_s, period_s, 1e-9);
    ASSERT_LE(way_m, run.options.max_speed_m_s * period_s + 1e-9);
    ASSERT_LE(std::abs(motion.phi), run.options.max_turn_rad_s * period_s + 1e-9);
  }
  EXPECT_NEAR(run.poses.back().travelled_m, kPath_m, run.options.max_speed_m_s * period_s);
  EXPECT_NEAR(length_m, kPath_m, 0.01 * kPath_m);
}

TEST(RobotPath, revisits_places_and_takes_corridors_in_both_directions) {
  const TestPath run = path_of(2);
  std::map<std::pair<int, int>, std::pair<bool, bool>> ways;  // directions seen in each square metre
  for (const PathPose& pose : run.poses) {
    const mrpt::math::TPose2D& at = pose.world_T_robot;
    auto& way = ways[{static_cast<int>(std::floor(at.x)), static_cast<int>(std::floor(at.y))}];
    (std::cos(at.phi) + std::sin(at.phi) > 0 ? way.first : way.second) = true;
  }
  const auto both = std::count_if(ways.begin(), ways.end(),
                                  [](const auto& way) { return way.second.first && way.second.second; });
  EXPECT_GT(both, static_cast<std::ptrdiff_t>(ways.size() / 2));
}

TEST(RobotPath, enters_rooms) {
  const TestPath run = path_of(3);
  std::size_t entered = 0;
  for (const Place& place : run.plan.places)
    if (place.kind == Place::Kind::kRoom)
      entered += std::any_of(run.poses.begin(), run.poses.end(), [&](const PathPose& pose) {
        return std::hypot(pose.world_T_robot.x - place.at.x, pose.world_T_robot.y - place.at.y) < 1;
      });
  EXPECT_GT(entered, run.plan.rooms() / 3);
}

}  // namespace
}  // namespace psi_slam
