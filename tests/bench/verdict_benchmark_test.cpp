// SPDX-License-Identifier: BSD-3-Clause
#include "verdict/verdict_benchmark.h"

#include <gmock/gmock.h>

#include <cmath>

#include "../verdict/two_passes.h"

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

TEST(VerdictBenchmark, measures_errors_after_the_best_alignment) {
  std::vector<TPose2D> truth;
  std::vector<TPose2D> path;
  for (int i = 0; i < 50; ++i) {
    truth.emplace_back(0.1 * i, std::sin(0.2 * i), 0);
    path.push_back(TPose2D(3, -2, 0.7) + truth.back());
  }
  EXPECT_NEAR(aligned_error_m(path, truth), 0, 1e-9);
  for (std::size_t i = 0; i < path.size(); ++i) path[i].x += i % 2 == 0 ? 0.1 : -0.1;
  EXPECT_NEAR(aligned_error_m(path, truth), 0.1, 0.01);
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

TEST(VerdictBenchmark, makes_each_kind_of_map_once) {
  VerdictBenchmarkOptions options;
  options.path_m = 20;
  const std::vector<VerdictRow> rows = run_verdict_benchmark(options, [](const auto&, double, double) {});
  EXPECT_EQ(rows.size(), kMapFaults.size());
  for (const VerdictRow& row : rows)
    if (row.fault == MapFault::kNone) {
      EXPECT_LT(row.error_m, 0.1);
      EXPECT_EQ(row.state, MapState::kGood);
    }
  const BenchReport report = verdict_report(rows, options, "a machine");
  EXPECT_THAT(report.markdown, HasSubstr("seed 1, 8 maps"));
  EXPECT_THAT(report.markdown, HasSubstr("| false loop | 1 |"));
}

}  // namespace
}  // namespace psi_slam
