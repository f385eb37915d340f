// SPDX-License-Identifier: BSD-3-Clause
#include "localization/prior_map.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "drawn_floor_plan.h"
#include "mapping/mapper_options.h"
#include "same_map.h"
#include "simulated_runs.h"

namespace psi_slam {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::uint64_t kBuildingPlan = 1;

/// A mapped run with what is known about it before the last steps.
struct MappedRun {
  Mapper mapper;
  TrueRun truth;
};

MappedRun mapped_run(std::uint64_t plan, std::uint64_t seed, double path_m, bool close_loops = true) {
  MapperOptions options;
  options.close_loops = close_loops;
  options.back_end.final_search.passes = 1;
  MappedRun run{Mapper(options), run_through(plan, seed, path_m)};
  for (const Frame& frame : run.truth.frames) run.mapper.add(frame);
  run.mapper.end_log();
  return run;
}

double mean_error_m(const MappingResult& result, const TrueRun& truth) {
  double sum = 0;
  for (std::size_t i = 0; i < result.frames.size(); ++i)
    sum += distance_m(result.frames[i].map_T_robot, truth.world_T_robot[i]);
  return sum / static_cast<double>(result.frames.size());
}

PriorPlaces places_in(const mrpt::maps::COccupancyGridMap2D& plan, const MappedRun& run,
                      const PriorMapOptions& options = {}) {
  return PriorMap(plan, options).places(run.mapper);
}

MappingResult aligned(MappedRun& run, PriorPlaces places) {
  FixedKnowledge knowledge;
  knowledge.poses = std::move(places.poses);
  run.mapper.set_knowledge(std::move(knowledge));
  return run.mapper.finish();
}

TEST(PriorMap, a_bare_floor_plan_places_a_run_through_furnished_rooms) {
  for (const std::uint64_t plan : {1U, 4U}) {
    for (const bool close_loops : {true, false}) {
      MappedRun run = mapped_run(plan, 100 + plan, 120, close_loops);
      PriorPlaces places = places_in(drawn_floor_plan(plan), run);
      EXPECT_GT(places.poses.size(), 20U) << places.objection;
      EXPECT_EQ(places.fitting, places.poses.size());
      EXPECT_GE(places.compared, places.fitting);
      const MappingResult result = aligned(run, std::move(places));
      EXPECT_LT(mean_error_m(result, run.truth), 0.05) << plan << ' ' << close_loops;
      EXPECT_THAT(result.contradictions, IsEmpty());
    }
  }
}

TEST(PriorMap, a_search_stops_when_its_progress_says_so) {
  const MappedRun run = mapped_run(kBuildingPlan, 101, 30);
  const PriorMap plan(drawn_floor_plan(kBuildingPlan), {});
  std::vector<double> shares;
  const PriorPlaces all = plan.places(run.mapper, {}, [&](double share) {
    shares.push_back(share);
    return true;
  });
  EXPECT_FALSE(all.is_interrupted);
  EXPECT_FALSE(all.poses.empty());
  ASSERT_GT(shares.size(), 2U);
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_LT(shares.back(), 1);
  for (const std::size_t calls : {std::size_t{1}, shares.size()}) {
    std::size_t called = 0;
    const PriorPlaces stopped = plan.places(run.mapper, {}, [&](double) { return ++called < calls; });
    EXPECT_EQ(called, calls);
    EXPECT_TRUE(stopped.is_interrupted);
    EXPECT_THAT(stopped.poses, IsEmpty());
  }
}

TEST(PriorMap, wrong_places_are_left_out_and_named_in_one_sentence) {
  MappedRun run = mapped_run(kBuildingPlan, 101, 120);
  PriorPlaces places = places_in(drawn_floor_plan(kBuildingPlan), run);
  ASSERT_GT(places.poses.size(), 20U);
  for (KnownPose& pose : places.poses) pose.source = "plan.yaml";
  for (const std::size_t wrong : {7U, 15U}) places.poses[wrong].site_T_robot.pose.x += 1.5;
  const MappingResult result = aligned(run, std::move(places));
  EXPECT_THAT(result.contradictions,
              ElementsAre(AllOf(HasSubstr("plan.yaml: the scans contradict this map at 2 of "),
                                HasSubstr("off by 1."))));
  EXPECT_LT(mean_error_m(result, run.truth), 0.05);
}

TEST(PriorMap, the_threads_do_not_change_a_bit) {
  const auto map_with = [](int threads) {
    MapperOptions options;
    options.back_end.final_search.passes = 1;
    options.back_end.threads = threads;
    MappedRun run{Mapper(options), run_through(kBuildingPlan, 101, 40)};
    for (const Frame& frame : run.truth.frames) run.mapper.add(frame);
    run.mapper.end_log();
    return aligned(run, places_in(drawn_floor_plan(kBuildingPlan), run));
  };
  const MappingResult one = map_with(1);
  EXPECT_EQ(one.graph.root(), one.node_frames.size()) << "aligned";
  expect_same_map(map_with(3), one);
}

TEST(PriorMap, the_offset_of_the_file_moves_the_places) {
  MappedRun run = mapped_run(kBuildingPlan, 101, 30);
  const PriorPlaces exact = places_in(drawn_floor_plan(kBuildingPlan), run);
  PriorMapOptions options;
  options.offset = {0.02, -0.01};
  const PriorPlaces moved = places_in(drawn_floor_plan(kBuildingPlan), run, options);
  ASSERT_EQ(moved.poses.size(), exact.poses.size());
  ASSERT_FALSE(exact.poses.empty());
  EXPECT_NEAR(moved.poses[0].site_T_robot.pose.x, exact.poses[0].site_T_robot.pose.x + 0.02, 1e-9);
  EXPECT_NEAR(moved.poses[0].site_T_robot.pose.y, exact.poses[0].site_T_robot.pose.y - 0.01, 1e-9);
}

/// The map with the walls in two of five squares of 2 m moved along x and y by 0.4 m each.
mrpt::maps::COccupancyGridMap2D with_moved_walls(const mrpt::maps::COccupancyGridMap2D& map) {
  const auto cells_of = [&](double metres) {
    return static_cast<int>(std::lround(metres / static_cast<double>(map.getResolution())));
  };
  const int square = cells_of(2);
  const int shift = cells_of(0.4);
  const int width = static_cast<int>(map.getSizeX());
  const int height = static_cast<int>(map.getSizeY());
  const auto moves = [&](int x, int y) { return (x / square * 7 + y / square * 3) % 5 < 2; };
  mrpt::maps::COccupancyGridMap2D moved = map;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (moves(x, y) && map.getCell(x, y) < 0.4F) moved.setCell(x, y, 1);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (moves(x, y) && map.getCell(x, y) < 0.4F && x + shift < width && y + shift < height)
        moved.setCell(x + shift, y + shift, 0);
  return moved;
}

TEST(PriorMap, a_building_of_which_many_walls_have_moved_still_places_a_run) {
  MappedRun run = mapped_run(kBuildingPlan, 101, 120);
  PriorPlaces places = places_in(with_moved_walls(drawn_floor_plan(kBuildingPlan)), run);
  EXPECT_GT(places.poses.size(), 5U) << places.objection;
  EXPECT_LT(places.fitting, places.compared) << "otherwise the test would show nothing";
  EXPECT_LT(mean_error_m(aligned(run, std::move(places)), run.truth), 0.1);
}

TEST(PriorMap, an_inaccurate_plan_and_a_short_run_are_no_reason_to_refuse) {
  const auto plan = drawn_floor_plan(kBuildingPlan);
  const MappedRun run = mapped_run(kBuildingPlan, 101, 60);
  for (const double sigma_m : {0.3, 2.0}) {
    PriorMapOptions options;
    options.sigma_m = sigma_m;
    EXPECT_THAT(places_in(plan, run, options).objection, "") << sigma_m;
  }
  EXPECT_THAT(places_in(plan, mapped_run(kBuildingPlan, 101, 20)).objection, "");
}

TEST(PriorMap, the_plan_of_another_building_is_refused) {
  const MappedRun run = mapped_run(kBuildingPlan, 101, 60);
  for (const std::uint64_t other : {51U, 54U}) {
    const PriorPlaces places = places_in(drawn_floor_plan(other), run);
    EXPECT_THAT(places.poses, IsEmpty()) << other;
    EXPECT_FALSE(places.objection.empty()) << other;
    EXPECT_LE(static_cast<double>(places.fitting), 0.7 * static_cast<double>(places.compared)) << other;
  }
}

}  // namespace
}  // namespace psi_slam
