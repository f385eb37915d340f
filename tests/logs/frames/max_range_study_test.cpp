// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/max_range_study.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "simulated_run.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using Change = std::function<void(std::vector<float>&)>;

/// Scan as a reader yields it, from a log that states this maximum range; 0: none.
LaserScan scan_of(const SimulatedRun& run, std::size_t i, double stated_m, const Change& change) {
  LaserScan scan = run.scan(i);
  change(scan.ranges_m);
  limit_ranges(scan, {}, stated_m);
  return scan;
}

void add(const SimulatedRun& run, double stated_m, const Change& change, MaxRangeStudy& study) {
  for (std::size_t i = 0; i < run.truth.size(); ++i) study.add(scan_of(run, i, stated_m, change));
}

MaxRange range_in(const SimulatedRun& run, double stated_m, const Change& change) {
  MaxRangeStudy study;
  add(run, stated_m, change, study);
  return study.max_ranges().at(0);
}

void keep(std::vector<float>&) {}

/// Writes a code instead of each reading of more than 6 m.
Change code_beyond_6_m(float code_m) {
  return [code_m](std::vector<float>& ranges_m) {
    for (float& range_m : ranges_m)
      if (range_m > 6) range_m = code_m;
  };
}

/// Rounds readings as lasers do that measure in steps of 5 cm.
void round_to_5_cm(std::vector<float>& ranges_m) {
  for (float& range_m : ranges_m) range_m = 0.05F * std::round(20 * range_m);
}

/// A corridor of 30 m, seen from its end by a robot that stands still.
SimulatedRun waiting_in_corridor(double noise_m) {
  SimulatedRun run = simulated_run({{0, 0, 400}}, {0.5, 0, 0});
  run.walls.clear();
  add_box(run.walls, 0, -1.02, 30.48, 1.02);
  run.noise_m = noise_m;
  return run;
}

TEST(MaxRangeStudy, codes_below_at_and_above_the_stated_maximum_are_no_returns) {
  const SimulatedRun run = round_trips(1);
  for (const float code_m : {8.18F, 8.19F, 9.19F}) {
    SCOPED_TRACE(code_m);
    MaxRangeStudy study;
    add(run, 8.19, code_beyond_6_m(code_m), study);
    const MaxRanges found = study.max_ranges();
    EXPECT_NEAR(found.at(0).max_range_m, code_m < 8.19F ? 8.175 : 8.19, 1e-6);
    EXPECT_NEAR(found.at(0).code_m, code_m < 8.19F ? 8.18 : 0, 1e-6);
    for (std::size_t i = 0; i < run.truth.size(); i += 10) {
      LaserScan scan = scan_of(run, i, 8.19, code_beyond_6_m(code_m));
      apply_max_range(found, scan);
      EXPECT_NEAR(scan.max_range_m, found.at(0).max_range_m, 1e-6);
      std::vector<float> expected_m = run.ranges_m(i);
      for (float& range_m : expected_m)
        if (range_m > 6) range_m = std::numeric_limits<float>::infinity();
      EXPECT_EQ(scan.ranges_m, expected_m);
    }
  }
}

TEST(MaxRangeStudy, a_log_that_states_no_maximum_has_50_m_or_its_code) {
  const SimulatedRun run = round_trips(1);
  EXPECT_EQ(range_in(run, 0, keep).max_range_m, 50);
  EXPECT_EQ(range_in(run, 0, code_beyond_6_m(50)).max_range_m, 50);
  EXPECT_NEAR(range_in(run, 0, code_beyond_6_m(81.83F)).max_range_m, 81.825, 1e-6);
  EXPECT_NEAR(range_in(run, 0, code_beyond_6_m(81.83F)).code_m, 81.83, 1e-6);
  EXPECT_FALSE(range_in(run, 0, code_beyond_6_m(81.83F)).is_surprise) << "no code below 50 m";
  EXPECT_TRUE(range_in(run, 0, code_beyond_6_m(8.19F)).is_surprise);
  EXPECT_NEAR(range_in(run, 0, code_beyond_6_m(65.535F)).max_range_m, 65.535, 1e-6);
  EXPECT_NEAR(range_in(run, 0, code_beyond_6_m(8.19F)).code_m, 8.19, 1e-6);
  EXPECT_NEAR(range_in(run, 0, code_beyond_6_m(8.19F)).max_range_m, 8.185, 1e-6);
}

TEST(MaxRangeStudy, a_code_that_rounds_to_the_stated_maximum_is_no_return) {
  const SimulatedRun run = round_trips(1);
  const MaxRange found = range_in(run, 8, code_beyond_6_m(7.9999F));
  EXPECT_EQ(found.code_m, 8);
  EXPECT_LT(found.max_range_m, 7.9999);
}

TEST(MaxRangeStudy, similar_codes_and_several_codes_are_no_returns) {
  const SimulatedRun run = round_trips(1);
  const auto codes = [](float first_m, float second_m) {
    return [first_m, second_m](std::vector<float>& ranges_m) {
      for (std::size_t i = 0; i < ranges_m.size(); ++i)
        if (ranges_m[i] > 6) ranges_m[i] = i % 4 == 0 ? first_m : second_m;
    };
  };
  EXPECT_NEAR(range_in(run, 100, codes(81.91F, 81.83F)).code_m, 81.83, 1e-6);
  EXPECT_NEAR(range_in(run, 100, codes(81.83F, 81.91F)).code_m, 81.83, 1e-6);
  EXPECT_NEAR(range_in(run, 100, codes(30, 20)).code_m, 20, 1e-6);
  EXPECT_NEAR(range_in(run, 0, codes(81.83F, 8.19F)).code_m, 8.19, 1e-6);
}

TEST(MaxRangeStudy, a_log_without_codes_keeps_its_stated_maximum) {
  for (const double noise_m : {0.0, 0.005, 0.02}) {
    SimulatedRun run = round_trips(1);
    run.noise_m = noise_m;
    for (const Change& change : {Change(keep), Change(round_to_5_cm)})
      for (const double stated_m : {5.0, 10.0, 30.0}) {
        SCOPED_TRACE(testing::Message() << noise_m << ' ' << stated_m);
        EXPECT_EQ(range_in(run, stated_m, change).code_m, 0);
        EXPECT_EQ(range_in(run, stated_m, change).max_range_m, stated_m);
      }
  }
}

TEST(MaxRangeStudy, walls_at_the_maximum_range_are_no_code) {
  SimulatedRun run = simulated_run({{0.05, 3, 240}}, {2, 1, 0});
  run.walls.clear();
  add_box(run.walls, 0, 0, 5, 5);
  for (const double noise_m : {0.0, 0.01}) {
    run.noise_m = noise_m;
    EXPECT_EQ(range_in(run, 5, keep).code_m, 0);
    EXPECT_EQ(range_in(run, 0, keep).code_m, 0);
    EXPECT_EQ(range_in(run, 5, round_to_5_cm).code_m, 0);
  }
}

TEST(MaxRangeStudy, a_robot_that_waits_in_front_of_a_wall_sees_no_code) {
  for (const double noise_m : {0.0, 0.005}) {
    SimulatedRun waiting = waiting_in_corridor(noise_m);
    EXPECT_EQ(range_in(waiting, 50, keep).code_m, 0);
    EXPECT_EQ(range_in(waiting, 50, round_to_5_cm).code_m, 0);
    MaxRangeStudy study;
    add(waiting, 50, round_to_5_cm, study);
    EXPECT_EQ(study.views(), 1U) << "a robot that stands still has one view";
    add(round_trips(1), 50, round_to_5_cm, study);
    EXPECT_GT(study.views(), MaxRangeStudy::kLeastViews);
    EXPECT_EQ(study.max_ranges().at(0).code_m, 0);
  }
}

TEST(MaxRangeStudy, people_who_pass_a_waiting_robot_add_no_views) {
  SimulatedRun waiting = waiting_in_corridor(0.005);
  waiting.put_into = [](std::vector<float>& ranges_m, std::size_t scan) {
    for (std::size_t i = 0; i < ranges_m.size() / 5; ++i)
      ranges_m[(7 * scan + i) % ranges_m.size()] = 0.5F + 0.01F * static_cast<float>(scan % 20);
  };
  MaxRangeStudy study;
  add(waiting, 50, keep, study);
  EXPECT_EQ(study.views(), 1U);
}

TEST(MaxRangeStudy, a_code_needs_views_that_show_it) {
  const SimulatedRun run = round_trips(1);
  MaxRangeStudy study;
  std::size_t before = 0;
  for (std::size_t i = 0; study.max_ranges()[0].code_m == 0; ++i) {
    ASSERT_LT(i, run.truth.size());
    before = study.views();
    study.add(scan_of(run, i, 10, code_beyond_6_m(9)));
  }
  EXPECT_GE(study.views(), MaxRangeStudy::kLeastViews);
  EXPECT_EQ(study.views(), before + 1) << "only a new view changes the result";
}

TEST(MaxRangeStudy, each_laser_has_its_own_code) {
  const SimulatedRun run = round_trips(1);
  MaxRangeStudy study;
  for (std::size_t i = 0; i < run.truth.size(); ++i)
    for (const std::size_t laser : {0U, 1U}) {
      LaserScan scan = scan_of(run, i, 10, laser == 0 ? Change(keep) : code_beyond_6_m(9));
      scan.laser = laser;
      study.add(scan);
    }
  const MaxRanges found = study.max_ranges();
  EXPECT_EQ(found.at(0).code_m, 0);
  EXPECT_EQ(found.at(1).code_m, 9);
  LaserScan first = scan_of(run, 0, 10, code_beyond_6_m(9));
  LaserScan second = first;
  second.laser = 1;
  apply_max_range(found, first);
  apply_max_range(found, second);
  EXPECT_EQ(first.max_range_m, 10);
  EXPECT_LT(second.max_range_m, 9);
}

TEST(MaxRangeStudy, a_maximum_of_one_scan_below_the_code_stays) {
  const MaxRanges found{{0, {{0, 0, 0}, 8, 10, 8.2}}};
  LaserScan scan;
  scan.ranges_m = {1, 6, 7.5F, 8, 8.2F};
  scan.max_range_m = 7;
  apply_max_range(found, scan);
  EXPECT_EQ(scan.max_range_m, 7);
  EXPECT_THAT(scan.ranges_m, testing::ElementsAre(1, 6, INFINITY, INFINITY, INFINITY));
}

TEST(MaxRangeStudy, says_which_code_applies_instead_of_what) {
  EXPECT_EQ(
      sentence_of({{0.2, 0, 0}, 81.825, 81.9, 81.83}),
      "the laser at x 0.20 m, y 0.00 m writes 81.83 m for \"no return\", although the log states a maximum "
      "range of 81.90 m, so such readings and longer ones count as no returns. State another maximum with "
      "log.max_range_m");
  EXPECT_THAT(sentence_of({{0.2, 0, 0}, 8.185, 0, 8.19}),
              testing::HasSubstr("although the log states no maximum range, so"));
}

}  // namespace
}  // namespace psi_slam
