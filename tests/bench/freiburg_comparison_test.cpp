// SPDX-License-Identifier: BSD-3-Clause
#include "freiburg/freiburg_comparison.h"

#include <gmock/gmock.h>

#include "well_formed.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;

/// Benchmark of one log that the adaptive matcher mapped with the mean translational error `error_m`. All
/// other mean errors are 1.
FreiburgBenchmark benchmark_with(const std::string& log, double error_m) {
  FreiburgResult run;
  run.figures.emplace();
  run.figures->errors = {{error_m, 0.5}, {1, 1}, {1, 1}, {1, 1}, {1, 1}};
  FreiburgBenchmark benchmark;
  benchmark.logs.push_back({log, "a", "b"});
  benchmark.cells.push_back({log, "csm", {{}}});
  benchmark.cells.push_back({log, "adaptive", {run}});
  return benchmark;
}

ComparisonRow row_of(const Comparison& comparison, const std::string& log, std::size_t figure) {
  for (const ComparisonRow& row : comparison.rows)
    if (row.log == log && row.figure == figure) return row;
  throw std::invalid_argument("no row of " + log);
}

/// Names of the columns that `row` marks as best.
std::vector<std::string> best_of(const Comparison& comparison, const ComparisonRow& row) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < row.best.size(); ++i)
    if (row.best[i]) names.push_back(comparison.columns[i].name);
  return names;
}

TEST(FreiburgComparison, the_best_system_has_the_least_mean) {
  using Names = std::vector<std::string>;
  const auto best_with = [](double error_m) {
    const Comparison comparison = compare_with_others(benchmark_with("intel", error_m));
    return best_of(comparison, row_of(comparison, "Intel", 0));
  };
  EXPECT_EQ(best_with(0.0199), Names{"psi-slam, adaptive"});
  EXPECT_EQ(best_with(0.03), Names{"graph FLIRT"});
  EXPECT_EQ(best_with(0.02), (Names{"psi-slam, adaptive", "graph FLIRT"}));
}

TEST(FreiburgComparison, the_table_shows_the_best_in_bold_and_has_every_log_of_the_benchmark) {
  const std::string table = comparison_table(compare_with_others(benchmark_with("intel", 0.01)));
  EXPECT_THAT(table, HasSubstr("| Intel | translation [m] | **0.0100 ± 0.5000** | 0.1650 ± 0.4700 |"));
  EXPECT_THAT(table, HasSubstr("| Intel | rotation [deg] | 1.0000 ± 1.0000 |"));
  EXPECT_THAT(table, HasSubstr("**0.3000 ± 0.3000**")) << "graph FLIRT";
  EXPECT_THAT(table, HasSubstr("| Freiburg hospital | translation [m] | – | 0.5750 ± 0.8360 |"));
}

TEST(FreiburgComparison, marks_means_without_failed_runs) {
  FreiburgBenchmark benchmark = benchmark_with("intel", 0.01);
  EXPECT_THAT(comparison_table(compare_with_others(benchmark)), testing::Not(HasSubstr("‡")));
  benchmark.cells[1].runs.emplace_back().failure = "no memory";
  const std::string some = comparison_table(compare_with_others(benchmark));
  EXPECT_THAT(some, HasSubstr("**0.0100 ± 0.5000 ‡**"));
  EXPECT_THAT(some, HasSubstr("\n‡ some runs failed"));
}

TEST(FreiburgComparison, baselines_run_here_are_columns) {
  FreiburgBenchmark benchmark = benchmark_with("intel", 0.01);
  benchmark.baselines.programs.push_back(
      {baseline_kinds()[0], "/usr/bin/icp-slam", "/some/icp.ini", "MRPT 9", "c"});
  BaselineResult result;
  result.log = "intel";
  result.baseline = "icp-slam";
  result.figures.emplace().errors.translation_abs_m = {0.005, 0.02};
  benchmark.baseline_results = {result};
  const Comparison comparison = compare_with_others(benchmark);
  EXPECT_EQ(best_of(comparison, row_of(comparison, "Intel", 0)).front(), "MRPT icp-slam (run here)");
  EXPECT_THAT(comparison.columns[1].source,
              testing::AllOf(HasSubstr("MRPT 9"), HasSubstr("icp.ini"), HasSubstr("SAVE_3D_SCENE = 0")));
  EXPECT_FALSE(row_of(comparison, "ACES", 0).values[1]);
}

TEST(FreiburgComparison, all_errors_of_csail_are_least_by_graph_mapping) {
  FreiburgBenchmark benchmark = benchmark_with("mit-csail", 0.03);
  benchmark.cells[1].runs[0].figures->errors = {{0.026, 0.02}, {0.001, 0.004}, {0.31, 0.3}, {0.17, 0.3}, {}};
  const Comparison comparison = compare_with_others(benchmark);
  for (std::size_t figure = 0; figure < kPaperFigures; ++figure)
    EXPECT_EQ(best_of(comparison, row_of(comparison, "MIT CSAIL", figure)),
              std::vector<std::string>{"graph mapping"});
}

TEST(FreiburgComparison, another_log_has_only_our_figures) {
  const Comparison comparison = compare_with_others(benchmark_with("my room", 0.02));
  const ComparisonRow row = row_of(comparison, "my room", 0);
  EXPECT_TRUE(row.values[0]);
  EXPECT_EQ(best_of(comparison, row).size(), 1U);
  EXPECT_EQ(comparison.rows.size(), (benchmark_log_titles().size() + 1) * kPaperFigures);
}

TEST(FreiburgComparison, compares_the_hospital_with_published_figures) {
  const Comparison comparison = compare_with_others(benchmark_with("hospital", 0.05));
  EXPECT_EQ(best_of(comparison, row_of(comparison, "Freiburg hospital", 0)).front(), "psi-slam, adaptive");
}

TEST(FreiburgComparison, draws_a_bar_for_each_system_that_has_the_figure) {
  const Comparison comparison = compare_with_others(benchmark_with("mit-csail", 0.03));
  const std::string svg = comparison_plot(comparison, "MIT CSAIL");
  EXPECT_EQ(complaint_about(svg), "");
  EXPECT_THAT(svg, HasSubstr("psi-slam, adaptive"));
  EXPECT_THAT(svg, HasSubstr("GMapping (live)"));
  EXPECT_THAT(svg, testing::Not(HasSubstr("Karto (paper)")));
  EXPECT_EQ(comparison_plot(comparison, "Intel"), "") << "it was not mapped";
}

}  // namespace
}  // namespace psi_slam
