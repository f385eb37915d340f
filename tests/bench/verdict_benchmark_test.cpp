// SPDX-License-Identifier: BSD-3-Clause
#include "verdict/verdict_benchmark.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "../map/verdict/two_passes.h"
#include "simulate/simulated_log_file.h"
#include "temporary_folder.h"
#include "verdict/known_run.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using testing::HasSubstr;

VerdictRow row_of(double error_m, double doubt_m) {
  VerdictRow row;
  row.error_m = error_m;
  row.doubt_m = doubt_m;
  return row;
}

TEST(VerdictBenchmark, ranks_wrong_maps_above_right_ones) {
  EXPECT_FALSE(area_under_curve({row_of(0.01, 0.1)}));
  EXPECT_EQ(area_under_curve({row_of(0.01, 0.1), row_of(1, 0.2)}), 1.0);
  EXPECT_EQ(area_under_curve({row_of(0.01, 0.1), row_of(1, 0.1)}), 0.5);
  EXPECT_EQ(area_under_curve({row_of(0.01, 0.1), row_of(0.02, 0.3), row_of(0.15, 9), row_of(1, 0.2)}), 0.5);
}

TEST(VerdictBenchmark, measures_the_distance_from_suspect_to_fault) {
  FaultyMap map;
  map.fault = MapFault::kSlip;
  map.error_m = 0.2;
  map.result = two_passes({0.3, 0, 0});
  for (std::size_t i = kScansPerRound - 3; i < kScansPerRound; ++i)
    map.result.frames[i].match = ScanMatch::kUnmatched;
  const TPose2D& slip = map.result.frames[kScansPerRound - 2].map_T_robot;
  map.places = {{slip.x + 0.5, slip.y}, {50, 50}};
  const VerdictRow row = judged(map);
  EXPECT_TRUE(is_fault_to_locate(row));
  ASSERT_TRUE(row.distance_m);
  EXPECT_NEAR(*row.distance_m, 0.5, 1e-6);
}

TEST(VerdictBenchmark, makes_each_kind_of_map_of_buildings_and_logs) {
  const TemporaryFolder folder;
  const BenchmarkLog log{"hall", folder.path() / "hall.clf.gz", {}, folder.path() / "hall.relations"};
  write_simulated_log(log.log, simulated_log_options(20, 4));
  VerdictBenchmarkOptions options;
  options.path_m = 20;
  const std::vector<VerdictRow> rows =
      run_verdict_benchmark({log}, options, [](const auto&, double, double) {});
  EXPECT_EQ(std::set<MapFault>(kMapFaults.begin(), kMapFaults.end()).size(), 9U);
  EXPECT_EQ(rows.size(), 2 * kMapFaults.size());
  for (const MapFault fault : kMapFaults)
    for (const std::string& name : {std::string(), log.name})
      EXPECT_EQ(std::count_if(rows.begin(), rows.end(),
                              [&](const VerdictRow& row) { return row.fault == fault && row.log == name; }),
                1)
          << name_of(fault);
  for (const VerdictRow& row : rows)
    if (row.fault == MapFault::kNone || row.fault == MapFault::kPaused) {
      EXPECT_LT(row.error_m, 0.1) << row.log;
      EXPECT_EQ(row.hot_spots, 0U) << row.log << ' ' << name_of(row.fault);
      EXPECT_EQ(row.state, MapState::kUnchecked) << "so short a path sees few places twice";
    }
  const BenchReport report = verdict_report(rows, options, "a machine");
  EXPECT_THAT(report.markdown, HasSubstr("seed 1 of the faults of the logs, 18 maps"));
  EXPECT_THAT(report.markdown, HasSubstr("| false loop | 1 |"));
  EXPECT_THAT(report.markdown, HasSubstr("| hall |"));
  EXPECT_THAT(report.markdown, HasSubstr("| good | unchecked | check | broken |"));
}

KnownRun straight_run() {
  KnownRun run;
  for (std::size_t i = 0; i < 20; ++i) {
    Frame frame;
    frame.index = i;
    frame.time_us = 200'000 * static_cast<TimeUs>(i);
    frame.odom_T_robot = {static_cast<double>(i), 0, 0};
    frame.scan.ranges_m = {1, 9, 1};
    run.frames.push_back(frame);
    run.world_T_robot.push_back(frame.odom_T_robot);
    run.scans.push_back(i);
  }
  return run;
}

TEST(KnownRun, is_degraded_with_its_truth) {
  RandomDraws draws(1, "test", 0);
  const KnownRun thinned = degraded(straight_run(), 3, 8, 0, draws);
  ASSERT_EQ(thinned.frames.size(), 7U);
  EXPECT_EQ(thinned.scans[2], 6U);
  EXPECT_EQ(thinned.frames[2].index, 2U);
  EXPECT_EQ(thinned.frames[2].odom_T_robot, thinned.world_T_robot[2]) << "without noise";
  EXPECT_TRUE(std::isinf(thinned.frames[2].scan.ranges_m[1]));

  KnownRun carried = straight_run();
  carry(carried, 5, 12);
  ASSERT_EQ(carried.frames.size(), 13U);
  EXPECT_EQ(carried.frames[5].odom_T_robot.x, 4) << "odometry knows nothing about it";
  EXPECT_EQ(carried.world_T_robot[5].x, 12);
  EXPECT_EQ(carried.scans[5], 12U);

  KnownRun paused = straight_run();
  pause(paused, 5, 60);
  EXPECT_EQ(paused.frames[5].odom_T_robot, TPose2D(0, 0, 0));
  EXPECT_EQ(paused.frames[5].time_us - paused.frames[4].time_us, 60'200'000);

  KnownRun slipped = straight_run();
  slip(slipped, 4, 8, {0.5, 0, 0});
  EXPECT_EQ(slipped.frames[5].odom_T_robot.x, 5);
  EXPECT_EQ(slipped.frames[6].odom_T_robot.x, 6.5);
  EXPECT_TRUE(std::isinf(slipped.frames[7].scan.ranges_m[0]));
  EXPECT_EQ(slipped.frames[8].scan.ranges_m[0], 1);
  EXPECT_EQ(frame_after(straight_run(), 3, 2.5), 6U);
}

TEST(KnownRun, measures_the_error_of_a_log_with_the_scans_that_were_thinned_out) {
  RandomDraws draws(1, "test", 0);
  KnownRun run = straight_run();
  auto truth = std::make_shared<LogTruth>();
  for (const Frame& frame : run.frames) truth->map.push_back({frame.time_us, frame.odom_T_robot});
  truth->relations = {{run.frames[1].time_us, run.frames[8].time_us, {7.25, 0, 0}}};
  run.truth = truth;
  const KnownRun thinned = degraded(run, 3, 8, 0, draws);
  MappingResult map;
  for (const Frame& frame : thinned.frames) {
    FrameRecord record;
    record.map_T_robot = frame.odom_T_robot;
    map.frames.push_back(record);
  }
  EXPECT_NEAR(mean_error_m(map, thinned), 0.25, 1e-9);
}

}  // namespace
}  // namespace psi_slam
