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

struct Driven {
  FloorPlan plan;
  RobotPathOptions options;
  std::vector<PathPose> poses;
};

Driven drive(std::uint64_t seed) {
  Driven driven;
  FloorPlanOptions plan;
  plan.seed = seed;
  plan.corridors_m = kPath_m / 4;
  driven.plan = draw_floor_plan(plan);
  driven.options.seed = seed;
  driven.options.path_m = kPath_m;
  RobotPath path(driven.plan, driven.options);
  while (const std::optional<PathPose> pose = path.next()) driven.poses.push_back(*pose);
  return driven;
}

TEST(RobotPath, crosses_no_wall_and_keeps_off_them) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Driven driven = drive(seed);
    for (std::size_t i = 1; i < driven.poses.size(); ++i) {
      const mrpt::math::TPoint2D before(driven.poses[i - 1].world_T_robot);
      const mrpt::math::TPoint2D now(driven.poses[i].world_T_robot);
      for (const PlanSegment& wall : driven.plan.segments)
        ASSERT_FALSE(cross_each_other(before, now, wall)) << "seed " << seed << ", pose " << i;
      ASSERT_GT(clearance_m(driven.plan, now), 0.2) << "seed " << seed << ", pose " << i;
    }
  }
}

TEST(RobotPath, is_as_long_as_wanted_and_never_too_fast) {
  const Driven driven = drive(1);
  const double period_s = 1 / driven.options.scan_rate_hz;
  double length_m = 0;
  for (std::size_t i = 1; i < driven.poses.size(); ++i) {
    const mrpt::math::TPose2D motion = driven.poses[i].world_T_robot - driven.poses[i - 1].world_T_robot;
    const double way_m = std::hypot(motion.x, motion.y);
    length_m += way_m;
    ASSERT_NEAR(driven.poses[i].time_s - driven.poses[i - 1].time_s, period_s, 1e-9);
    ASSERT_LE(way_m, driven.options.max_speed_m_s * period_s + 1e-9);
    ASSERT_LE(std::abs(motion.phi), driven.options.max_turn_rad_s * period_s + 1e-9);
  }
  EXPECT_NEAR(driven.poses.back().travelled_m, kPath_m, driven.options.max_speed_m_s * period_s);
  EXPECT_NEAR(length_m, kPath_m, 0.01 * kPath_m);
}

TEST(RobotPath, comes_by_again_and_drives_corridors_both_ways) {
  const Driven driven = drive(2);
  std::map<std::pair<int, int>, std::pair<bool, bool>> ways;  // by square metre: up or right, down or left
  for (const PathPose& pose : driven.poses) {
    const mrpt::math::TPose2D& at = pose.world_T_robot;
    auto& way = ways[{static_cast<int>(std::floor(at.x)), static_cast<int>(std::floor(at.y))}];
    (std::cos(at.phi) + std::sin(at.phi) > 0 ? way.first : way.second) = true;
  }
  const auto both = std::count_if(ways.begin(), ways.end(),
                                  [](const auto& way) { return way.second.first && way.second.second; });
  EXPECT_GT(both, static_cast<std::ptrdiff_t>(ways.size() / 2));
}

TEST(RobotPath, enters_rooms) {
  const Driven driven = drive(3);
  std::size_t entered = 0;
  for (const Place& place : driven.plan.places)
    if (place.kind == Place::Kind::kRoom)
      entered += std::any_of(driven.poses.begin(), driven.poses.end(), [&](const PathPose& pose) {
        return std::hypot(pose.world_T_robot.x - place.at.x, pose.world_T_robot.y - place.at.y) < 1;
      });
  EXPECT_GT(entered, driven.plan.rooms() / 3);
}

}  // namespace
}  // namespace psi_slam
