// SPDX-License-Identifier: BSD-3-Clause
#include "observations/rawlog_objects.h"

#include <gtest/gtest.h>
#include <mrpt/obs/CObservationOdometry.h>

namespace psi_slam {
namespace {

std::optional<TimeUs> read_back(mrpt::Clock::time_point stamp) {
  mrpt::obs::CObservationOdometry observation;
  observation.timestamp = stamp;
  return time_us(observation);
}

TEST(RawlogObjects, count_time_as_mrpt_does) {
  for (const TimeUs time : {TimeUs{0}, TimeUs{976052905167303}}) {
    EXPECT_NEAR(mrpt::Clock::toDouble(mrpt_clock_time(time)), seconds(time), 1e-6);
    EXPECT_EQ(read_back(mrpt_clock_time(time)), time);
  }
  EXPECT_EQ(read_back(mrpt_clock_time(-1'500'000)), -1'500'000);
}

TEST(RawlogObjects, round_time_to_the_nearest_microsecond) {
  const mrpt::Clock::time_point whole = mrpt_clock_time(1'000);
  EXPECT_EQ(read_back(whole + mrpt::Clock::duration(4)), 1'000);
  EXPECT_EQ(read_back(whole + mrpt::Clock::duration(5)), 1'001);
  EXPECT_EQ(read_back(whole - mrpt::Clock::duration(4)), 1'000);
}

TEST(RawlogObjects, tell_when_there_is_no_time_stamp) {
  EXPECT_EQ(read_back(INVALID_TIMESTAMP), std::nullopt);
}

}  // namespace
}  // namespace psi_slam
