// SPDX-License-Identifier: BSD-3-Clause
#include "freiburg/freiburg_benchmark.h"

#include <gtest/gtest.h>

#include <cmath>

namespace psi_slam {
namespace {

FreiburgResult run_with(std::uint64_t seed, double error_m) {
  FreiburgResult run;
  run.seed = seed;
  run.figures.emplace();
  run.figures->errors.translation_abs_m = {error_m, 2 * error_m};
  run.figures->duration_s = 100;
  run.figures->wall_s = error_m;
  run.figures->loops_accepted = seed;
  run.figures->loops_judged = 10 * seed;
  run.figures->loops_false = seed - 1;
  return run;
}

TEST(FreiburgFigures, are_the_mean_and_the_spread_over_the_seeds) {
  const FreiburgCell cell{"room", "ga", {run_with(1, 1), run_with(2, 2), run_with(3, 6)}};
  const auto figures = figures_of(cell);
  ASSERT_TRUE(figures);
  EXPECT_EQ(figures->runs, 3U);
  EXPECT_DOUBLE_EQ(figures->errors.translation_abs_m.mean, 3) << "not the best one";
  EXPECT_DOUBLE_EQ(figures->errors.translation_abs_m.std, 6);
  EXPECT_DOUBLE_EQ(figures->spread[0].min, 1);
  EXPECT_DOUBLE_EQ(figures->spread[0].max, 6);
  EXPECT_DOUBLE_EQ(figures->spread[0].std, std::sqrt(14.0 / 2)) << "of a sample";
  EXPECT_DOUBLE_EQ(figures->loops_accepted.mean, 2);
  EXPECT_DOUBLE_EQ(figures->real_time_factor.max, 100);
}

TEST(FreiburgFigures, judge_the_loops_over_the_seeds) {
  FreiburgCell cell{"room", "ga", {run_with(1, 1), run_with(2, 1), run_with(3, 1)}};
  EXPECT_DOUBLE_EQ(figures_of(cell)->loops_judged.mean, 20);
  EXPECT_DOUBLE_EQ(figures_of(cell)->loops_false.mean, 1);
  EXPECT_DOUBLE_EQ(figures_of(cell)->loops_false.max, 2);
  EXPECT_FALSE(figures_of(cell)->loop_recall);
  cell.runs[0].figures->loop_recall = 0.5;
  cell.runs[2].figures->loop_recall = 1;
  EXPECT_DOUBLE_EQ(figures_of(cell)->loop_recall.value().mean, 0.75);
}

TEST(FreiburgFigures, leave_out_runs_that_failed_and_count_them) {
  FreiburgCell cell{"room", "ga", {run_with(1, 1), {}, run_with(3, 3)}};
  cell.runs[1].failure = "no memory";
  const auto figures = figures_of(cell);
  ASSERT_TRUE(figures);
  EXPECT_EQ(figures->runs, 2U);
  EXPECT_EQ(figures->failed, 1U);
  EXPECT_DOUBLE_EQ(figures->errors.translation_abs_m.mean, 2);
  EXPECT_EQ(figures->spread[0].count, 2U);
  EXPECT_FALSE(figures_of({"room", "ga", {{}}}));
}

}  // namespace
}  // namespace psi_slam
