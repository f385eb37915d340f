// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/localizer.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "degraded_map.h"
#include "localization/localization_report.h"
#include "simulated_runs.h"
#include "simulation/scan_simulator.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using testing::HasSubstr;
using State = LocalizationStep::State;

constexpr std::uint64_t kBuilding = 1;
constexpr double kTracked_m = 0.2;  // largest accepted distance of a tracked pose from the true pose

/// Map of the building kBuilding, made once for all tests.
const mrpt::maps::COccupancyGridMap2D& building_map() {
  static const auto kMap = map_of(run_through(kBuilding, 1, 200));
  return kMap;
}

double worst_m(const std::vector<LocalizationStep>& steps, const TrueRun& truth) {
  double worst = 0;
  for (std::size_t i = 0; i < steps.size(); ++i)
    if (steps[i].state == State::kTracking)
      worst = std::max(worst, distance_m(steps[i].map_T_robot, truth.world_T_robot[i]));
  return worst;
}

TEST(Localizer, finds_and_tracks_a_robot_without_start) {
  for (const MatcherKind matcher : {MatcherKind::kCsm, MatcherKind::kCsmGa, MatcherKind::kGa}) {
    const TrueRun run = run_through(kBuilding, 101, 30);
    LocalizerOptions options;
    options.search.matcher = matcher;
    Localizer localizer(reference_of(building_map()), options);
    const auto steps = localize(localizer, run.frames);
    EXPECT_LT(worst_m(steps, run), kTracked_m) << name(matcher);
    const LocalizationSummary summary = summarize(steps);
    ASSERT_TRUE(summary.found()) << name(matcher) << ": " << summary.why_not;
    EXPECT_EQ(summary.times_found, 1);
    EXPECT_EQ(summary.times_lost, 0);
    EXPECT_LT(*summary.found_after_m, 15) << name(matcher);
    EXPECT_TRUE(summary.ambiguity.has_value());
  }
}

TEST(Localizer, the_same_scans_give_the_same_poses) {
  const TrueRun run = run_through(kBuilding, 101, 10);
  std::string first;
  for (int pass = 0; pass < 2; ++pass) {
    Localizer localizer(reference_of(building_map()), {});
    const std::string csv = localization_csv(localize(localizer, run.frames));
    if (pass == 0) first = csv;
    EXPECT_EQ(csv, first);
  }
}

TEST(Localizer, with_a_start_it_tracks_from_the_first_scan) {
  const TrueRun run = run_through(kBuilding, 102, 20);
  Localizer localizer(reference_of(building_map()), {});
  TPose2D about = run.world_T_robot.front();
  about.x += 0.6;
  about.y -= 0.4;
  about.phi += 0.15;
  localizer.start_at(about);
  const auto steps = localize(localizer, run.frames);
  EXPECT_LT(worst_m(steps, run), kTracked_m);
  const LocalizationSummary summary = summarize(steps);
  EXPECT_EQ(summary.tracked, steps.size());
  EXPECT_EQ(summary.searches, 0);
}

TEST(Localizer, recovers_from_a_wrong_start) {
  const TrueRun run = run_through(kBuilding, 102, 40);
  Localizer localizer(reference_of(building_map()), {});
  localizer.start_at({-30, -30, 0});
  const auto steps = localize(localizer, run.frames);
  EXPECT_EQ(steps.back().state, State::kTracking);
  EXPECT_LT(distance_m(steps.back().map_T_robot, run.world_T_robot.back()), kTracked_m);
}

TEST(Localizer, does_not_find_a_robot_in_the_map_of_another_building) {
  const TrueRun run = run_through(51, 101, 20);
  Localizer localizer(reference_of(building_map()), {});
  const LocalizationSummary summary = summarize(localize(localizer, run.frames));
  EXPECT_FALSE(summary.found());
  EXPECT_GT(summary.searches, 10);
  EXPECT_THAT(localization_text(summary), HasSubstr("Not found"));
}

/// The building kBuilding as another program may map it from another recording.
mrpt::maps::COccupancyGridMap2D degraded_building() {
  MapFaults faults;
  faults.displaced_cells = 1;
  faults.thickened_cells = 1;
  faults.speck_share = 0.01;
  faults.furniture_per_m2 = 1.0 / 5;
  return degraded(building_map(), faults);
}

TEST(Localizer, finds_a_robot_in_a_map_with_thick_walls_specks_and_other_furniture) {
  const auto map = degraded_building();
  const TrueRun run = run_through(kBuilding, 101, 20);
  Localizer localizer(reference_of(map), {});
  const auto steps = localize(localizer, run.frames);
  EXPECT_TRUE(summarize(steps).found()) << summarize(steps).why_not;
  EXPECT_LT(worst_m(steps, run), kTracked_m);

  LocalizerOptions strict;
  strict.search.min_clear_share_alone = strict.search.min_clear_share;
  Localizer strict_localizer(reference_of(map), strict);
  const LocalizationSummary summary = summarize(localize(strict_localizer, run.frames));
  EXPECT_FALSE(summary.found()) << "too few faults to test anything";
  EXPECT_THAT(summary.why_not, HasSubstr("of the beams pass through no wall"));
}

TEST(Localizer, does_not_find_a_robot_in_a_bad_map_of_another_building) {
  const auto map = degraded_building();
  for (const std::uint64_t building : {51U, 52U}) {
    Localizer localizer(reference_of(map), {});
    const LocalizationSummary summary = summarize(localize(localizer, run_through(building, 101, 20).frames));
    EXPECT_FALSE(summary.found());
    EXPECT_GT(summary.searches, 10);
  }
}

// The robot is moved by hand in the middle of the run. Odometry does not measure this move.
TEST(Localizer, recovers_when_the_robot_is_moved_by_hand) {
  TrueRun run = run_through(kBuilding, 103, 90);
  const std::size_t third = run.frames.size() / 3;
  std::size_t away = third;  // frame in the second third of the run that is farthest from frame `third`
  for (std::size_t i = third; i < 2 * third; ++i)
    if (distance_m(run.world_T_robot[i], run.world_T_robot[third]) >
        distance_m(run.world_T_robot[away], run.world_T_robot[third]))
      away = i;
  ASSERT_GT(distance_m(run.world_T_robot[away], run.world_T_robot[third - 1]), 5);
  const TPose2D before = run.frames[third - 1].odom_T_robot;
  const TPose2D after = run.frames[away].odom_T_robot;
  const auto cut = [&](auto& all) {
    all.erase(all.begin() + static_cast<std::ptrdiff_t>(third),
              all.begin() + static_cast<std::ptrdiff_t>(away));
  };
  cut(run.frames);
  cut(run.world_T_robot);
  for (std::size_t i = third; i < run.frames.size(); ++i)
    run.frames[i].odom_T_robot = before + (run.frames[i].odom_T_robot - after);

  Localizer localizer(reference_of(building_map()), {});
  const auto steps = localize(localizer, run.frames);
  EXPECT_EQ(steps[third - 1].state, State::kTracking);
  EXPECT_LT(distance_m(steps[third - 1].map_T_robot, run.world_T_robot[third - 1]), kTracked_m);
  const LocalizationSummary summary = summarize(steps);
  EXPECT_GE(summary.times_lost, 1);
  EXPECT_GE(summary.times_found, 2);
  EXPECT_EQ(steps.back().state, State::kTracking);
  EXPECT_LT(distance_m(steps.back().map_T_robot, run.world_T_robot.back()), kTracked_m);
}

/// Scans taken from each of the poses in turn, 0.2 s apart, with perfect odometry.
TrueRun scanned_from(const std::vector<TPose2D>& poses, const FloorPlan& plan,
                     const ScanSimulatorOptions& options) {
  ScanSimulator scanner(plan, options);
  TrueRun run;
  for (const TPose2D& pose : poses) {
    Frame frame;
    frame.index = run.frames.size();
    frame.time_us = 1'000'000'000 + static_cast<TimeUs>(frame.index) * 200'000;
    frame.odom_T_robot = pose;
    frame.scan = scanner.scan(pose, {}, frame.index);
    run.frames.push_back(std::move(frame));
    run.world_T_robot.push_back(pose);
  }
  return run;
}

/// A hall with rotational symmetry of 180 degrees, and a run around its centre.
TrueRun round_a_symmetric_hall(std::uint64_t seed) {
  static const FloorPlan kHall = [] {
    FloorPlan plan;
    const auto wall = [&](double x0, double y0, double x1, double y1) {
      plan.segments.push_back({{x0, y0}, {x1, y1}, Material::kWall});
      plan.segments.push_back({{-x0, -y0}, {-x1, -y1}, Material::kWall});
    };
    wall(-8, -5, 8, -5);
    wall(8, -5, 8, 5);
    wall(2, -5, 2, -4);
    wall(5, -5, 6, -4);
    wall(8, 1, 7, 2);
    return plan;
  }();
  ScanSimulatorOptions options;
  options.seed = seed;
  constexpr std::size_t kScans = 120;
  std::vector<TPose2D> poses;
  for (std::size_t i = 0; i < kScans; ++i) {
    const double turn = 2 * M_PI * static_cast<double>(i) / kScans;
    poses.emplace_back(4 * std::cos(turn), 2.5 * std::sin(turn),
                       std::atan2(2.5 * std::cos(turn), -4 * std::sin(turn)));
  }
  return scanned_from(poses, kHall, options);
}

TEST(Localizer, reports_an_ambiguous_building_instead_of_guessing) {
  Localizer localizer(reference_of(map_of(round_a_symmetric_hall(1))), {});
  const LocalizationSummary summary = summarize(localize(localizer, round_a_symmetric_hall(2).frames));
  EXPECT_FALSE(summary.found());
  EXPECT_TRUE(summary.ambiguous);
  EXPECT_THAT(localization_text(summary), HasSubstr("another place fits as well"));
}

constexpr double kTwin_m = 12;         // distance between the axes of the twin corridors
constexpr double kCorridorEnd_m = 16;  // x of the corridors' east ends
constexpr double kSight_m = 6;         // range of the laser in the twin corridors

/// Two equal corridors along x, side by side. At their east ends lie rooms of different shapes.
FloorPlan twin_corridors() {
  FloorPlan plan;
  const auto wall = [&](double x0, double y0, double x1, double y1) {
    plan.segments.push_back({{x0, y0}, {x1, y1}, Material::kWall});
  };
  for (const double y : {0.0, kTwin_m}) {
    wall(0, y - 1, 0, y + 1);
    wall(0, y - 1, kCorridorEnd_m, y - 1);
    wall(0, y + 1, 5, y + 1);
    wall(5, y + 1, 5, y + 2);  // a niche
    wall(5, y + 2, 7, y + 2);
    wall(7, y + 2, 7, y + 1);
    wall(7, y + 1, kCorridorEnd_m, y + 1);
    wall(11, y - 1, 11, y - 0.6);  // a pillar
    wall(11.5, y - 1, 11.5, y - 0.6);
    wall(11, y - 0.6, 11.5, y - 0.6);
    const bool first = y == 0;
    const double south = y - (first ? 4 : 1.5);
    const double north = y + (first ? 1.5 : 6);
    const double east = kCorridorEnd_m + (first ? 9 : 11);
    wall(kCorridorEnd_m, y - 1, kCorridorEnd_m, south);
    wall(kCorridorEnd_m, y + 1, kCorridorEnd_m, north);
    wall(kCorridorEnd_m, south, east, south);
    wall(kCorridorEnd_m, north, east, north);
    wall(east, south, east, north);
  }
  return plan;
}

/// A run along the corridor with the axis y, from its west end into the room at its east end, and back to the
/// door.
TrueRun along_corridor(double y, std::uint64_t seed) {
  static const FloorPlan kPlan = twin_corridors();
  ScanSimulatorOptions options;
  options.seed = seed;
  options.max_range_m = kSight_m;
  std::vector<TPose2D> poses;
  for (double x = 1; x < kCorridorEnd_m + 6; x += 0.1) poses.emplace_back(x, y, 0);
  for (double turned_rad = 0; turned_rad < M_PI; turned_rad += 0.1)
    poses.emplace_back(kCorridorEnd_m + 6, y, turned_rad);
  for (double x = kCorridorEnd_m + 6; x > kCorridorEnd_m + 1; x -= 0.1) poses.emplace_back(x, y, M_PI);
  return scanned_from(poses, kPlan, options);
}

TrueRun joined(TrueRun run, const TrueRun& more) {
  run.frames.insert(run.frames.end(), more.frames.begin(), more.frames.end());
  run.world_T_robot.insert(run.world_T_robot.end(), more.world_T_robot.begin(), more.world_T_robot.end());
  return run;
}

/// Number of ambiguous searches before a scan shows the room at the end. Expects that the robot is not found
/// by then.
int ambiguous_searches_before_room(const std::vector<LocalizationStep>& steps, const TrueRun& run) {
  int ambiguous = 0;
  for (std::size_t i = 0; i < steps.size() && run.world_T_robot[i].x + kSight_m < kCorridorEnd_m; ++i) {
    EXPECT_EQ(steps[i].state, State::kLost) << "both corridors fit at x = " << run.world_T_robot[i].x;
    ambiguous += steps[i].search && steps[i].search->ambiguous ? 1 : 0;
  }
  return ambiguous;
}

TEST(Localizer, keeps_twin_corridors_apart_until_a_scan_decides) {
  const auto map = map_of(joined(along_corridor(0, 1), along_corridor(kTwin_m, 2)));
  for (const double y : {0.0, kTwin_m}) {
    const TrueRun run = along_corridor(y, 3);
    Localizer localizer(reference_of(map), {});
    const auto steps = localize(localizer, run.frames);
    EXPECT_GE(ambiguous_searches_before_room(steps, run), 5) << "the other corridor was not found";
    EXPECT_EQ(steps.back().state, State::kTracking) << "corridor at y = " << y;
    EXPECT_LT(worst_m(steps, run), kTracked_m) << "corridor at y = " << y;
  }
}

/// A hall without symmetry.
FloorPlan uneven_hall() {
  FloorPlan plan;
  const auto wall = [&](double x0, double y0, double x1, double y1) {
    plan.segments.push_back({{x0, y0}, {x1, y1}, Material::kWall});
  };
  wall(-9, -5, 9, -5);
  wall(9, -5, 9, 3);
  wall(9, 3, 4, 6);
  wall(4, 6, -9, 6);
  wall(-9, 6, -9, -5);
  wall(-3, -5, -3, -3);
  wall(1, 6, 1, 4.5);
  wall(5, -5, 6, -3);
  wall(6, -3, 7, -5);
  return plan;
}

// Near 180 degrees, the genetic search repeats its search with other headings. The check must find the place
// in them too.
TEST(Localizer, checks_places_with_headings_near_180_degrees) {
  const FloorPlan plan = uneven_hall();
  ScanSimulatorOptions options;
  options.seed = 1;
  std::vector<TPose2D> tour;
  for (double turned_rad = 0; turned_rad < 2 * M_PI; turned_rad += 0.1)
    tour.emplace_back(5 * std::cos(turned_rad), 1.5 * std::sin(turned_rad), turned_rad);
  const auto map = map_of(scanned_from(tour, plan, options));
  for (const double off_rad : {-0.009, -0.006, -0.003, 0.0, 0.003, 0.006, 0.009}) {
    options.seed = 2;
    std::vector<TPose2D> poses;
    for (double way_m = 0; way_m < 6; way_m += 0.1)
      poses.emplace_back(3 - way_m * std::cos(off_rad), -way_m * std::sin(off_rad), M_PI + off_rad);
    const TrueRun run = scanned_from(poses, plan, options);
    Localizer localizer(reference_of(map), {});
    const auto steps = localize(localizer, run.frames);
    for (const LocalizationStep& step : steps) {
      if (!step.search) continue;
      EXPECT_TRUE(step.search->found) << off_rad << ": " << step.search->objection;
    }
    EXPECT_EQ(steps.back().state, State::kTracking) << off_rad;
    EXPECT_LT(worst_m(steps, run), kTracked_m) << off_rad;
  }
}

TEST(Localizer, checks_what_a_genetic_search_found_by_an_exact_search) {
  const TrueRun first = along_corridor(0, 1);
  const TrueRun second = along_corridor(kTwin_m, 2);
  LocalizerOptions weak;
  weak.search.matcher = MatcherKind::kGa;
  weak.search.genetic.memetic.seeds = 1;  // finds one of the corridors
  weak.search.genetic.memetic.generations = 0;
  Localizer localizer(reference_of(map_of(joined(first, second))), weak);
  const TrueRun run = along_corridor(0, 3);
  EXPECT_GE(ambiguous_searches_before_room(localize(localizer, run.frames), run), 3);
}

}  // namespace
}  // namespace psi_slam
