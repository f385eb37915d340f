// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/floor_plan.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "plan_geometry.h"

namespace psi_slam {
namespace {

FloorPlan plan_of(std::uint64_t seed, double corridors_m = 300) {
  FloorPlanOptions options;
  options.seed = seed;
  options.corridors_m = corridors_m;
  return draw_floor_plan(options);
}

bool same(const FloorPlan& a, const FloorPlan& b) {
  const auto same_segment = [](const PlanSegment& one, const PlanSegment& other) {
    return one.from == other.from && one.to == other.to && one.material == other.material;
  };
  return a.segments.size() == b.segments.size() &&
         std::equal(a.segments.begin(), a.segments.end(), b.segments.begin(), same_segment);
}

std::size_t count(const FloorPlan& plan, Material material) {
  return static_cast<std::size_t>(
      std::count_if(plan.segments.begin(), plan.segments.end(),
                    [&](const PlanSegment& segment) { return segment.material == material; }));
}

/// Number of places that are reachable from the first place.
std::size_t reachable(const FloorPlan& plan) {
  std::vector<bool> reached(plan.places.size(), false);
  reached[0] = true;
  for (bool more = true; more;) {
    more = false;
    for (const Passage& passage : plan.passages)
      if (reached[passage.from] != reached[passage.to]) {
        reached[passage.from] = reached[passage.to] = true;
        more = true;
      }
  }
  return static_cast<std::size_t>(std::count(reached.begin(), reached.end(), true));
}

TEST(FloorPlan, depends_on_the_seed_alone) {
  EXPECT_TRUE(same(plan_of(3), plan_of(3)));
  EXPECT_FALSE(same(plan_of(3), plan_of(4)));
}

TEST(FloorPlan, scale_enlarges_rooms_and_corridors_but_not_the_requested_size) {
  FloorPlanOptions options;
  options.corridors_m = 300;
  const FloorPlan plan = draw_floor_plan(options);
  options.corridors_m = 900;
  options.scale = 3;
  const FloorPlan large = draw_floor_plan(options);
  EXPECT_GE(large.corridors_m(), 900);
  EXPECT_EQ(large.rooms(), plan.rooms());
  ASSERT_EQ(large.segments.size(), plan.segments.size());
  EXPECT_EQ(large.segments.back().to, plan.segments.back().to * 3);
  EXPECT_EQ(large.places.back().at, plan.places.back().at * 3);
  EXPECT_EQ(large.corridors.back().from, plan.corridors.back().from * 3);
  EXPECT_EQ(large.corridors.back().width_m, plan.corridors.back().width_m * 3);
  options.scale = 0.5;
  EXPECT_THROW(draw_floor_plan(options), std::invalid_argument);
}

TEST(FloorPlan, has_the_requested_size) {
  for (const double wanted_m : {10.0, 300.0, 3000.0}) {
    const FloorPlan plan = plan_of(1, wanted_m);
    EXPECT_GE(plan.corridors_m(), wanted_m);
    EXPECT_LT(plan.corridors_m(), 1.5 * wanted_m + 120) << "once round a block at least";
  }
}

TEST(FloorPlan, has_rooms_rings_and_all_materials) {
  const FloorPlan plan = plan_of(1, 600);
  EXPECT_GT(plan.rooms(), 20U);
  EXPECT_GT(plan.passages.size(), plan.places.size()) << "a tree has one passage less than places";
  for (const Material material : {Material::kWall, Material::kGlass, Material::kPillar, Material::kFurniture})
    EXPECT_GT(count(plan, material), 0U);
}

TEST(FloorPlan, has_the_requested_share_of_glass) {
  FloorPlanOptions options;
  options.glass_share = 0;
  EXPECT_EQ(count(draw_floor_plan(options), Material::kGlass), 0U);
}

TEST(FloorPlan, every_place_is_reachable) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const FloorPlan plan = plan_of(seed);
    EXPECT_EQ(reachable(plan), plan.places.size()) << "seed " << seed;
  }
}

TEST(FloorPlan, passages_keep_their_distance_from_all_segments) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const FloorPlan plan = plan_of(seed);
    for (const Passage& passage : plan.passages) {
      const mrpt::math::TPoint2D from = plan.places[passage.from].at;
      const mrpt::math::TPoint2D way = plan.places[passage.to].at - from;
      const int steps = 1 + static_cast<int>(std::hypot(way.x, way.y) / 0.1);
      for (int step = 0; step <= steps; ++step)
        ASSERT_GE(clearance_m(plan, from + way * (static_cast<double>(step) / steps)), kPlanClearance_m)
            << "seed " << seed << ", from " << from.x << ' ' << from.y << " by " << way.x << ' ' << way.y;
    }
  }
}

}  // namespace
}  // namespace psi_slam
