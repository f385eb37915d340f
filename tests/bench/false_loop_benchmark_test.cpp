// SPDX-License-Identifier: BSD-3-Clause
#include "false_loops/false_loop_benchmark.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "../pose_graph/test_graphs.h"
#include "false_loops/bent_path.h"
#include "pose_graph/spanning_tree.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;

/// Graph of a building with closed loops, and the poses of its nodes by odometry alone.
LoopTrial building_trial() {
  const KnownGraph known = building(1000, 2, 2);
  LoopTrial trial;
  trial.graph = known.graph;
  trial.unlooped = spanning_tree_poses(trial.graph);
  SparsePoseAdjustment solver;
  solver.optimize(trial.graph);
  trial.error = [truth = known.truth](const std::vector<TPose2D>& map_T_node) {
    double sum = 0;
    for (std::size_t i = 0; i < truth.size(); ++i)
      sum += std::hypot(map_T_node[i].x - truth[i].x, map_T_node[i].y - truth[i].y);
    return LoopTrial::Error{sum / static_cast<double>(truth.size()), 0};
  };
  return trial;
}

TEST(FalseLoopBenchmark, the_back_end_survives_10_100_and_500_percent) {
  const LoopTrial trial = building_trial();
  const double error_m = trial.error(trial.graph.poses()).translation_m;
  EXPECT_GT(trial.error(trial.unlooped).translation_m, 3 * error_m) << "loops are needed";
  for (const FalseLoopKind kind :
       {FalseLoopKind::kScattered, FalseLoopKind::kGroups, FalseLoopKind::kNearby}) {
    for (const double share_percent : {10, 100, 500}) {
      SCOPED_TRACE(name_of(kind) + ", " + std::to_string(share_percent) + " %");
      const FalseLoopRow row = run_loop_trial(trial, kind, share_percent, 1);
      EXPECT_EQ(row.false_loops, std::lround(share_percent / 100 * static_cast<double>(row.true_loops)));
      EXPECT_EQ(row.undefended.false_kept, row.false_loops);
      if (kind != FalseLoopKind::kNearby) {  // the errors of nearby loops average out
        EXPECT_GT(row.undefended.error.translation_m, 1.1 * error_m);
      }
      for (const LoopTrialOutcome* outcome : {&row.defended, &row.from_map}) {
        EXPECT_LT(outcome->error.translation_m, 1.1 * error_m);
        EXPECT_LE(outcome->false_kept, row.false_loops / 100);
        EXPECT_LE(outcome->true_lost, row.true_loops / 50);
      }
    }
  }
}

TEST(FalseLoopBenchmark, loops_straighten_a_path_with_slips) {
  const LoopTrial trial = building_trial();
  for (const double share_percent : {0, 10}) {
    SCOPED_TRACE(share_percent);
    BentPathOptions bend;
    bend.share = share_percent / 100;
    const double bent_m = trial.error(bent(trial.graph, trial.unlooped, bend).unlooped).translation_m;
    const FalseLoopRow row = run_loop_trial(trial, FalseLoopKind::kSlips, share_percent, bend.seed);
    EXPECT_EQ(static_cast<double>(row.false_loops), share_percent / 100 * 20);  // 1,000 nodes
    for (const LoopTrialOutcome* outcome : {&row.defended, &row.from_map}) {
      EXPECT_LT(outcome->error.translation_m, 0.5 * bent_m);
      EXPECT_LT(outcome->true_lost, row.true_loops / 2);
    }
    if (share_percent == 0) {
      EXPECT_EQ(row.defended.true_lost, 0U);
    }
  }
}

TEST(FalseLoopBenchmark, is_reported_as_page_json_csv_and_plots) {
  FalseLoopBenchmark benchmark;
  benchmark.logs = {{"office", 100, 40, {0.02, 0.5}, {0.3, 1.5}}};
  FalseLoopRow row;
  row.log = "office";
  row.kind = FalseLoopKind::kGroups;
  row.share_percent = 50;
  row.false_loops = 20;
  row.undefended.error.translation_m = 7;
  row.defended = {{0.0213, 0.6}, 3, 4, 12};
  FalseLoopRow other = row;
  other.seed = 2;
  other.defended = {{0.0413, 0.8}, 5, 4, 14};
  benchmark.rows = {row, other};
  benchmark.identities = {{"office", "a0a0", "b0b0"}};
  FalseLoopBenchmarkOptions options;
  options.seeds = {1, 2};
  const BenchReport report = false_loop_report(benchmark, options, "a machine");
  EXPECT_THAT(
      report.markdown,
      testing::AllOf(HasSubstr("| office | groups | 50 | 20 | 7.000 ± 0.000 [7.000] |"),
                     HasSubstr("| office | `a0a0` | `b0b0` |"),
                     HasSubstr("| 0.0313 ± 0.0141 [0.0413] | 0.700 ± 0.141 [0.800] | 4.0 / 4.0 | 13 |"),
                     HasSubstr("a machine; seeds 1 to 2")));
  const auto json = nlohmann::json::parse(report.json);
  EXPECT_EQ(json["rows"][0]["kind"], "groups");
  EXPECT_EQ(json["rows"][0]["defended"]["true_lost"]["mean"], 4);
  EXPECT_EQ(json["rows"].size(), 1U);
  EXPECT_EQ(json["files"][0]["sha256"], "a0a0");
  EXPECT_EQ(json["logs"][0]["without_loops"]["translation_error_m"], 0.3);
  EXPECT_THAT(report.csv, HasSubstr("\noffice,groups,50.0,1 2,0,20,7.0,0.0,7.0,7.0,"));
  ASSERT_EQ(report.plots.size(), 4U);
  const std::string& plot = report.plots[1].content;
  EXPECT_EQ(report.plots[1].file, "false-loops-groups.svg");
  EXPECT_THAT(plot, testing::AllOf(HasSubstr(">50 %<"), HasSubstr(">office<"), HasSubstr("10 m<"),
                                   HasSubstr("class=\"spread\"")));
  EXPECT_EQ(std::count(plot.begin(), plot.end(), '<') - std::count(plot.begin(), plot.end(), '>'), 0);
}

}  // namespace
}  // namespace psi_slam
