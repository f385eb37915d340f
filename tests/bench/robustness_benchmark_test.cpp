// SPDX-License-Identifier: BSD-3-Clause
#include "robustness/robustness_benchmark.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "room_benchmark.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

std::vector<const RobustnessRow*> rows_of(const RobustnessBenchmark& benchmark, const std::string& series) {
  std::vector<const RobustnessRow*> rows;
  for (const RobustnessRow& row : benchmark.rows)
    if (row.degraded.series == series && row.seed == 4) rows.push_back(&row);
  return rows;
}

class RobustnessBenchmarks : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const TemporaryFolder folder;
    write_room_benchmark(folder.path(), folder.path());
    write_room_passes(folder.path());
    benchmark_ = run_robustness_benchmark(find_benchmark_logs(folder.path(), folder.path()), {4, 5},
                                          [](const std::string&, double done, double all) {
                                            EXPECT_GE(done, last_done_);
                                            EXPECT_LE(done, all);
                                            last_done_ = done;
                                          });
  }

  static inline RobustnessBenchmark benchmark_;  // computed once for all tests
  static inline double last_done_ = 0;
};

TEST(RobustnessCases, start_each_series_with_the_unchanged_log) {
  std::vector<std::string> names;
  for (const RobustnessCase& degraded : robustness_cases(7)) {
    names.push_back(degraded.series + ": " + degraded.name);
    EXPECT_EQ(degraded.degradation.seed, 7U);
  }
  EXPECT_THAT(names, testing::ElementsAre("odometry noise: × 1", "odometry noise: × 2", "odometry noise: × 4",
                                          "odometry noise: no odometry", "scans kept: 1 of 1",
                                          "scans kept: 1 of 2", "scans kept: 1 of 3", "scans kept: 1 of 5",
                                          "field of view: full", "field of view: 90°"));
}

TEST_F(RobustnessBenchmarks, has_a_row_for_each_case) {
  const std::vector<RobustnessCase> cases = robustness_cases(1);
  std::size_t next = 0;
  for (const RobustnessCase& degraded : cases)
    for (const std::uint64_t seed : {4U, 5U}) {
      if (seed == 5 && !draws_random_numbers(degraded)) continue;
      ASSERT_LT(next, benchmark_.rows.size());
      const RobustnessRow& row = benchmark_.rows[next++];
      EXPECT_EQ(row.log, "room");
      EXPECT_EQ(row.degraded.series, degraded.series);
      EXPECT_EQ(row.degraded.name, degraded.name);
      EXPECT_EQ(row.seed, seed);
      EXPECT_LT(row.translation_error_m, 0.1) << "the room is easy";
      EXPECT_EQ(row.loop_precision, 1);
    }
  EXPECT_EQ(next, benchmark_.rows.size());
  EXPECT_EQ(next, cases.size() + 2) << "two cases of noise";
}

TEST_F(RobustnessBenchmarks, another_seed_gives_other_noise) {
  for (std::size_t i = 1; i < benchmark_.rows.size(); ++i)
    if (benchmark_.rows[i].seed == 5) {
      EXPECT_NE(benchmark_.rows[i].translation_error_m, benchmark_.rows[i - 1].translation_error_m);
    }
  EXPECT_EQ(benchmark_.identities.at(0).sha256.size(), 64U);
}

TEST_F(RobustnessBenchmarks, the_unchanged_log_has_the_same_figures_in_each_series) {
  const RobustnessRow& first = benchmark_.rows.front();
  for (const char* series : {"scans kept", "field of view"}) {
    const RobustnessRow& same = *rows_of(benchmark_, series).front();
    EXPECT_EQ(same.translation_error_m, first.translation_error_m);
    EXPECT_EQ(same.scans, first.scans);
    EXPECT_EQ(same.loops, first.loops);
  }
}

TEST_F(RobustnessBenchmarks, fewer_scans_are_worse) {
  const std::vector<const RobustnessRow*> rows = rows_of(benchmark_, "scans kept");
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[0]->scans, 190U);
  EXPECT_EQ(rows[1]->scans, 95U);
  EXPECT_EQ(rows[2]->scans, 64U);
  EXPECT_EQ(rows[3]->scans, 38U);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    EXPECT_LT(rows[i]->loops, rows[i - 1]->loops);
    EXPECT_LE(rows[i]->relations, rows[i - 1]->relations);
    EXPECT_GE(rows[i]->translation_error_m, rows.front()->translation_error_m);
  }
}

TEST_F(RobustnessBenchmarks, a_narrow_field_of_view_and_noisy_odometry_are_worse) {
  const std::vector<const RobustnessRow*> views = rows_of(benchmark_, "field of view");
  EXPECT_GT(views.at(1)->translation_error_m, views.at(0)->translation_error_m);
  EXPECT_EQ(views.at(1)->scans, views.at(0)->scans);
  const std::vector<const RobustnessRow*> noises = rows_of(benchmark_, "odometry noise");
  constexpr double kTolerance_m = 1e-3;  // noise may lower the error by chance
  for (std::size_t i = 1; i < noises.size(); ++i)
    EXPECT_GE(noises[i]->translation_error_m, noises.front()->translation_error_m - kTolerance_m);
}

TEST_F(RobustnessBenchmarks, measures_the_natural_noise_of_the_log) {
  ASSERT_EQ(benchmark_.logs.size(), 1U);
  const OdometryNoise& natural = benchmark_.logs.front().natural;
  EXPECT_LT(natural.sigma_m_per_root_m, 0.02) << "its distances are right";
  EXPECT_NEAR(natural.sigma_rad_per_root_rad, 0.0136, 0.005)
      << "its rotations are 2 % too large, at 0.68 rad per stretch";
}

}  // namespace
}  // namespace psi_slam
