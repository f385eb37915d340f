// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/scan_place.h"

#include <gtest/gtest.h>

namespace psi_slam {
namespace {

TEST(ScanPlace, is_rounded_to_a_decimetre) {
  EXPECT_EQ(place_text({3.14, -2.0}), "(3.1, -2.0) m");
}

TEST(TimeInRun, begins_at_the_first_frame_of_each_run) {
  std::vector<FrameRecord> frames(6);
  const TimeUs times_us[] = {10'000'000, 11'000'000, 12'500'000, 3'000'000, 3'500'000, 90'000'000};
  for (std::size_t i = 0; i < frames.size(); ++i) frames[i].time_us = times_us[i];
  const std::vector<std::size_t> later_run_frames = {3, 5};
  const double expected_s[] = {0, 1, 2.5, 0, 0.5, 0};
  for (std::size_t i = 0; i < frames.size(); ++i)
    EXPECT_EQ(time_in_run_s(frames, later_run_frames, i), expected_s[i]) << i;
}

}  // namespace
}  // namespace psi_slam
