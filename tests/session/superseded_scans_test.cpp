// SPDX-License-Identifier: BSD-3-Clause
#include "session/superseded_scans.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "logs/frames/discarded_ranges.h"

namespace psi_slam {
namespace {

std::vector<Frame> frames(std::size_t count) {
  const auto bearings = std::make_shared<const std::vector<float>>(std::vector<float>{-0.5F, 0, 0.5F});
  std::vector<Frame> frames(count);
  for (std::size_t i = 0; i < count; ++i) {
    frames[i].index = i;
    frames[i].time_us = 1'000'000 + static_cast<TimeUs>(i) * 100'000;
    frames[i].odom_T_robot = {0.1 * static_cast<double>(i), 0, 0};
    frames[i].scan.ranges_m = {1 + 0.01F * static_cast<float>(i), 2, 3};
    frames[i].scan.bearings_rad = bearings;
    frames[i].scan.max_range_m = 30;
  }
  return frames;
}

TEST(SupersededScans, come_back_to_the_last_bit) {
  const std::vector<Frame> all = frames(1000);
  std::vector<Frame> left = all;
  SupersededScans kept;
  EXPECT_TRUE(kept.empty());
  // Out of order, with some in the file and some that still wait for it.
  for (std::size_t i = 699; i >= 100; --i) {
    kept.add(i, left[i]);
    discard_ranges(left[i]);
  }
  EXPECT_FALSE(kept.empty());
  for (int round = 0; round < 2; ++round) {
    std::vector<Frame> whole = left;
    kept.put_back(whole);
    ASSERT_EQ(whole.size(), all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_EQ(whole[i].index, i);
      EXPECT_EQ(whole[i].time_us, all[i].time_us);
      EXPECT_EQ(whole[i].odom_T_robot, all[i].odom_T_robot);
      EXPECT_EQ(whole[i].scan.ranges_m, all[i].scan.ranges_m);
      ASSERT_TRUE(whole[i].scan.bearings_rad);
      EXPECT_EQ(*whole[i].scan.bearings_rad, *all[i].scan.bearings_rad);
      EXPECT_EQ(whole[i].scan.max_range_m, all[i].scan.max_range_m);
    }
    kept.add(700 + static_cast<std::size_t>(round), left[700 + static_cast<std::size_t>(round)]);
  }
}

}  // namespace
}  // namespace psi_slam
