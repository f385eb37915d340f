// SPDX-License-Identifier: BSD-3-Clause
// Compares maps of two runs through one simulated building, which show different parts of its rooms.
#include <gtest/gtest.h>

#include "localization/comparison/wall_changes.h"
#include "psi_slam/grid_map.h"
#include "simulation/simulated_log.h"

namespace psi_slam {
namespace {

FloorPlanOptions building() {
  FloorPlanOptions options = simulated_log_options(1, 7).plan;
  options.corridors_m = 90;
  options.glass_share = 0;
  return options;
}

/// Map of a run of 150 m, drawn at the true poses in the frame of the floor plan.
mrpt::maps::COccupancyGridMap2D map_of_run(std::uint64_t seed) {
  SimulatedLogOptions options = simulated_log_options(150, seed);
  options.plan = building();
  SimulatedLog log(options);
  std::vector<Frame> frames;
  std::vector<mrpt::math::TPose2D> world_T_robot;
  while (std::optional<Frame> frame = log.next()) {
    frames.push_back(*std::move(frame));
    world_T_robot.push_back(log.world_T_robot());
  }
  return *draw_grid_map(frames, world_T_robot);
}

TEST(UnchangedBuilding, two_runs_give_no_change) {
  const auto first = map_of_run(1);
  for (const std::uint64_t run : {2U, 3U}) {
    const WallChanges found = find_wall_changes(first, map_of_run(run), {0, 0, 0});
    EXPECT_GT(found.compared_m2, 200) << "run " << run;
    for (const WallChange& change : found.changes)
      ADD_FAILURE() << "run " << run << ", " << change.length_m << " m at " << change.middle().asString();
  }
}

TEST(UnchangedBuilding, a_wall_across_a_corridor_is_found) {
  const auto first = map_of_run(1);
  auto second = map_of_run(2);
  const Corridor corridor = draw_floor_plan(building()).corridors.front();
  const auto along = (corridor.to - corridor.from) * (1 / (corridor.to - corridor.from).norm());
  const auto middle = (corridor.from + corridor.to) * 0.5;
  for (double across_m = -0.4; across_m <= 0.4; across_m += 0.01)
    second.setPos(static_cast<float>(middle.x - along.y * across_m),
                  static_cast<float>(middle.y + along.x * across_m), 0);
  const WallChanges found = find_wall_changes(first, second, {0, 0, 0});
  ASSERT_EQ(found.changes.size(), 1U);
  EXPECT_EQ(found.changes[0].kind, WallChange::Kind::kAppeared);
  EXPECT_NEAR(found.changes[0].length_m, 0.85, 0.1);
  EXPECT_LT((found.changes[0].middle() - middle).norm(), 0.1);
}

}  // namespace
}  // namespace psi_slam
