// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/simulated_log.h"

#include <gtest/gtest.h>

#include "plan_geometry.h"

namespace psi_slam {
namespace {

TEST(WalkingPeople, walk_in_corridors_at_a_walking_speed) {
  const FloorPlan plan = draw_floor_plan({});
  const WalkingPeople people(plan, 20, 1);
  auto before = people.at(0);
  ASSERT_EQ(before.size(), 20U);
  for (int step = 1; step < 3000; ++step) {
    const auto now = people.at(0.1 * step);
    for (std::size_t i = 0; i < now.size(); ++i) {
      ASSERT_LE(std::hypot(now[i].x - before[i].x, now[i].y - before[i].y), 0.15 + 1e-9);
      double off_m = 1e9;
      for (const Corridor& corridor : plan.corridors)
        off_m = std::min(
            off_m, distance_m(now[i], {corridor.from, corridor.to, Material::kWall}) - corridor.width_m / 2);
      ASSERT_LE(off_m, -kPersonRadius_m);
    }
    before = now;
  }
}

}  // namespace
}  // namespace psi_slam
