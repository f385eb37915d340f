// SPDX-License-Identifier: BSD-3-Clause
#include "paper/paper_benchmark.h"

#include <gmock/gmock.h>

namespace psi_slam {
namespace {

using testing::HasSubstr;
using testing::Not;

FrameRecord frame(double time_s, bool searched, double loop_ms, double graph_ms) {
  FrameRecord record;
  record.time_us = static_cast<TimeUs>(1e6 * time_s);
  record.searched_loops = searched;
  record.loop_closing_ms = loop_ms;
  record.pose_graph_ms = graph_ms;
  return record;
}

TEST(PaperBenchmark, the_scan_period_is_the_median_time_between_scans) {
  EXPECT_EQ(scan_period_ms({}), 0);
  EXPECT_EQ(scan_period_ms({frame(1, false, 0, 0)}), 0);
  const std::vector<FrameRecord> frames{frame(1, false, 0, 0), frame(1.2, false, 0, 0),
                                        frame(1.5, false, 0, 0), frame(60, false, 0, 0)};
  EXPECT_NEAR(scan_period_ms(frames), 300, 1e-9) << "a gap of a minute does not matter";
}

TEST(PaperBenchmark, a_search_misses_the_deadline_if_both_bounds_of_its_time_exceed_the_period) {
  const std::vector<FrameRecord> frames{frame(0, false, 500, 0), frame(1, true, 90, 0),
                                        frame(2, true, 90, 20), frame(3, true, 400, 100),
                                        frame(4, true, 90, 11)};
  const BackEndTimes times = back_end_times(frames, {600, 95, 120, 80, 102}, 100);
  EXPECT_EQ(times.searches, 4U);
  EXPECT_EQ(times.deadline_misses, 2U) << "110 and 101 ms; other programs delayed the scan of 500 ms";
  EXPECT_EQ(times.p50_ms, 90);
  EXPECT_EQ(times.p99_ms, 110);
  EXPECT_EQ(times.max_ms, 110);
}

TEST(PaperBenchmark, every_candidate_has_the_windows_of_the_paper_and_settings_of_its_own) {
  std::vector<std::string> seen;
  for (const PaperCandidate& candidate : paper_candidates()) {
    SCOPED_TRACE(candidate.name);
    const MapperOptions options = mapper_options(paper_settings({}, candidate, 7));
    const LoopCandidateOptions& windows = options.back_end.loop_closure.candidates;
    EXPECT_EQ(windows.max_window.x_m, 8);
    EXPECT_EQ(windows.min_window_m, 8);
    EXPECT_EQ(windows.min_window_rad, windows.max_window.theta_rad);
    EXPECT_FALSE(is_wide(windows.max_window, options.back_end.loop_closure.verification))
        << "the paper matches a single scan";
    EXPECT_EQ(options.back_end.seed, 7U);
    EXPECT_EQ(options.back_end.threads, 1);
    EXPECT_EQ(options.back_end.final_search.passes, 0);
    const bool is_paper = candidate.name.find("paper") != std::string::npos;
    EXPECT_EQ(options.back_end.genetic.variant, is_paper ? GeneticVariant::kPaper : GeneticVariant::kMemetic);
    const bool is_switch = candidate.name.rfind("switch", 0) == 0;
    EXPECT_EQ(options.back_end.matcher.has_value(), !is_switch);
    if (is_switch) {
      EXPECT_EQ(matcher_kind({}, options.back_end.psi, 0), MatcherKind::kCsm);
      EXPECT_GT(options.back_end.psi.max_poses, 1e15) << "the paper chooses by Psi alone";
    }
  }
  PaperOptions some;
  some.matchers = {"switch", "csm"};
  ASSERT_EQ(some.candidates().size(), 2U);
  EXPECT_EQ(some.candidates()[0].name, "csm");
  EXPECT_EQ(PaperOptions().candidates().size(), paper_candidates().size());
}

PaperBenchmark figures() {
  PaperBenchmark result;
  PaperRow row;
  row.log = "intel";
  row.matcher = "csm";
  row.figures.errors.translation_abs_m = {0.25, 0.125};
  row.loops = 12;
  row.loops_judged = 7;
  row.loops_false = 1;
  row.windows = 40;
  row.searches[static_cast<std::size_t>(SearchKind::kExhaustive)] = 10;
  row.searches[static_cast<std::size_t>(SearchKind::kBranchAndBound)] = 30;
  row.period_ms = 200;
  row.times = {20, 3, 90.04, 250, 300};
  result.rows = {row, row, row};
  result.rows[1].matcher = "ga";
  result.rows[2].log = "fhw";
  return result;
}

TEST(PaperReport, has_loops_deadlines_times_and_searches) {
  const BenchReport report = paper_report(figures(), {}, "a machine");
  EXPECT_EQ(report.page, "paper.md");
  EXPECT_THAT(report.markdown,
              HasSubstr("| intel | csm | 12 | 1 of 7 | 40 | 200 | 3 of 20 | 90.0 | 250.0 | 300.0 | "
                        "branch_and_bound 75.0 %, exhaustive 25.0 % |\n"));
  EXPECT_THAT(report.markdown, HasSubstr("switch_paper: switch by Ψ"));
  const auto rows = nlohmann::json::parse(report.json)["rows"];
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0]["deadline_misses"], 3);
  EXPECT_EQ(rows[0]["searches"], 20);
  EXPECT_EQ(rows[0]["search_kinds"]["branch_and_bound"], 30);
  EXPECT_EQ(rows[0]["translation_abs_m"]["std"], 0.125);
  EXPECT_EQ(rows[0]["back_end_ms"]["max"], 300.0);
  EXPECT_THAT(report.csv, HasSubstr("search_kinds.genetic"));
}

TEST(PaperReport, has_the_tables_of_the_paper_below_the_logs_that_they_have) {
  const std::string page = paper_report(figures(), {}, "a machine").markdown;
  EXPECT_THAT(page, HasSubstr("| intel | ga | 0.2500 ± 0.1250 |"));
  EXPECT_THAT(page, HasSubstr("| intel | GA-based (paper) | 0.1650 ± 0.4700 | 0.3060 ± 1.9240 |"));
  EXPECT_THAT(page, HasSubstr("| intel | Karto (paper) | 0.2070 ± 0.8230 |"));
  EXPECT_THAT(page, Not(HasSubstr("| intel | GMapping (paper)"))) << "not in the paper";
  EXPECT_THAT(page, Not(HasSubstr("| fhw | GA-based")));
  EXPECT_THAT(page, Not(HasSubstr("Cartographer")));
}

}  // namespace
}  // namespace psi_slam
