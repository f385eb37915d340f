// SPDX-License-Identifier: BSD-3-Clause
#include "freiburg/baselines.h"

#include <gmock/gmock.h>

#include "psi_slam/open_log.h"
#include "psi_slam/user_error.h"
#include "room_benchmark.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

TEST(BaselineLog, is_read_back_as_the_same_log) {
  const TemporaryFolder folder;
  write_room_benchmark(folder.path(), folder.path());
  const std::filesystem::path written = folder.path() / "written.rawlog";
  const auto never = [] { return false; };
  const std::vector<TimeUs> times = write_baseline_log(*open_log(folder.path() / "room.log"), written, never);
  ASSERT_EQ(times.size(), 190U);
  const auto log = open_log(folder.path() / "room.log");
  const auto again = open_log(written);
  mrpt::math::TPose2D log_start;
  mrpt::math::TPose2D again_start;
  for (const TimeUs time_us : times) {
    const Frame frame = log->next().value();
    const Frame same = again->next().value();
    if (frame.index == 0) {
      log_start = frame.odom_T_robot;
      again_start = same.odom_T_robot;
    }
    ASSERT_EQ(frame.time_us, time_us);
    ASSERT_EQ(same.time_us, time_us);
    const mrpt::math::TPose2D moved = frame.odom_T_robot - log_start;
    const mrpt::math::TPose2D moved_again = same.odom_T_robot - again_start;
    ASSERT_NEAR(moved.x, moved_again.x, 1e-9);
    ASSERT_NEAR(moved.y, moved_again.y, 1e-9);
    ASSERT_NEAR(std::remainder(moved.phi - moved_again.phi, 2 * M_PI), 0, 1e-9);
    ASSERT_EQ(same.scan.robot_T_laser, frame.scan.robot_T_laser);
    ASSERT_EQ(same.scan.ranges_m.size(), frame.scan.ranges_m.size());
    for (std::size_t beam = 0; beam < frame.scan.ranges_m.size(); ++beam) {
      ASSERT_EQ(std::isfinite(same.scan.ranges_m[beam]), std::isfinite(frame.scan.ranges_m[beam]));
      if (std::isfinite(frame.scan.ranges_m[beam])) {
        ASSERT_EQ(same.scan.ranges_m[beam], frame.scan.ranges_m[beam]);
      }
      ASSERT_NEAR((*same.scan.bearings_rad)[beam], (*frame.scan.bearings_rad)[beam], 1e-5);
    }
  }
  EXPECT_FALSE(again->next());
}

TEST(BaselineLog, is_removed_after_an_interrupt) {
  const TemporaryFolder folder;
  write_room_benchmark(folder.path(), folder.path());
  const std::filesystem::path written = folder.path() / "written.rawlog";
  EXPECT_THROW(write_baseline_log(*open_log(folder.path() / "room.log"), written, [] { return true; }),
               SystemFailure);
  EXPECT_FALSE(std::filesystem::exists(written));
}

}  // namespace
}  // namespace psi_slam
