// SPDX-License-Identifier: BSD-3-Clause
#include "sparse/sensor_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace psi_slam {
namespace {

class SensorSweep : public testing::Test {
 protected:
  static std::vector<SensorSweepRow> rows(int threads) {
    SensorSweepOptions options;
    options.max_ranges_m = {8};
    options.spacings_deg = {1, 2};
    options.steps_m = {0.1, 0.5};
    options.path_m = 30;
    options.threads = threads;
    return run_sensor_sweep(options, Settings(),
                            [](const std::string&, double done, double all) { EXPECT_LE(done, all); });
  }

  static void SetUpTestSuite() { rows_ = rows(1); }
  static inline std::vector<SensorSweepRow> rows_;  // computed once for all tests
};

TEST_F(SensorSweep, has_a_row_for_each_range_spacing_and_step) {
  ASSERT_EQ(rows_.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(rows_[i].max_range_m, 8);
    EXPECT_EQ(rows_[i].spacing_deg, i < 2 ? 1 : 2);
    EXPECT_EQ(rows_[i].step_m, i % 2 == 0 ? 0.1 : 0.5);
    EXPECT_NEAR(rows_[i].path_m, 30, 0.2);
    EXPECT_GT(rows_[i].error_m, 0);
    EXPECT_LT(rows_[i].error_m, 0.3);
    EXPECT_LE(rows_[i].false_loops, rows_[i].loops);
  }
}

TEST_F(SensorSweep, longer_steps_keep_fewer_scans_of_the_same_run) {
  EXPECT_GE(rows_[0].scans, 300U) << "30 m in steps of at most 0.1 m";
  EXPECT_GE(rows_[1].scans, 50U);
  EXPECT_LT(rows_[1].scans, rows_[0].scans / 3);
  EXPECT_EQ(rows_[0].scans, rows_[2].scans) << "the path does not depend on the beams";
}

TEST_F(SensorSweep, gives_the_same_rows_on_two_threads) {
  const std::vector<SensorSweepRow> again = rows(2);
  ASSERT_EQ(again.size(), rows_.size());
  for (std::size_t i = 0; i < again.size(); ++i) {
    EXPECT_EQ(again[i].spacing_deg, rows_[i].spacing_deg);
    EXPECT_EQ(again[i].error_m, rows_[i].error_m);
    EXPECT_EQ(again[i].loops, rows_[i].loops);
  }
}

TEST(BuildingScale, grows_with_the_range_and_is_at_least_one) {
  EXPECT_EQ(building_scale(4), 1);
  EXPECT_EQ(building_scale(8), 1);
  EXPECT_EQ(building_scale(32), 2);
}

}  // namespace
}  // namespace psi_slam
