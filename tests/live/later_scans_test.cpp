// SPDX-License-Identifier: BSD-3-Clause
#include "live/later_scans.h"

#include <gmock/gmock.h>

#include "frames_in_memory.h"
#include "sender.h"

namespace psi_slam {
namespace {

using testing::ElementsAre;

/// Times of the scans at `times_us` that follow a recording that ends at 5 s.
std::vector<TimeUs> later_us(const std::vector<TimeUs>& times_us, Notices& notices) {
  std::vector<Frame> frames;
  for (const TimeUs time_us : times_us) frames.emplace_back().time_us = time_us;
  LaterScans later(std::make_unique<FramesInMemory>(frames), 5'000'000,
                   {[] { return false; }, [&](const std::string& notice) { notices.add(notice); }});
  std::vector<TimeUs> later_us;
  while (const auto frame = later.next()) later_us.push_back(frame->time_us);
  return later_us;
}

TEST(LaterScans, begin_after_the_recorded_ones) {
  Notices notices;
  EXPECT_THAT(later_us({1'000'000, 4'000'000, 5'000'000, 6'000'000, 7'000'000}, notices),
              ElementsAre(6'000'000, 7'000'000));
  EXPECT_EQ(notices.text(), "skipping scans up to 5.000000 s, the time of the last recorded scan\n");
  EXPECT_THAT(later_us({1'000'000}, notices), ElementsAre());
}

TEST(LaterScans, are_all_scans_of_a_robot_that_went_on) {
  Notices notices;
  EXPECT_THAT(later_us({6'000'000, 4'000'000, 7'000'000}, notices),
              ElementsAre(6'000'000, 4'000'000, 7'000'000));
  EXPECT_EQ(notices.text(), "");
}

}  // namespace
}  // namespace psi_slam
