// SPDX-License-Identifier: BSD-3-Clause
#include "map/exports/interruptions.h"

#include <gmock/gmock.h>

namespace psi_slam {
namespace {

TEST(Interruptions, say_when_the_robot_was_moved_and_found) {
  MappingResult result;
  EXPECT_TRUE(interruption_texts(result).empty());
  for (const TimeUs time_s : {100, 107, 230, 294, 3700}) {
    FrameRecord record;
    record.time_us = time_s * 1'000'000;
    result.frames.push_back(record);
  }
  result.interruptions = {{2, 3}, {4, std::nullopt}};
  EXPECT_THAT(interruption_texts(result),
              testing::ElementsAre(
                  "the place of the robot was lost between 0:07 and 2:10, and found again at 3:14",
                  "the place of the robot was lost between 3:14 and 1:00:00, and was not found again: "
                  "the scans "
                  "from there on are drawn beside the map, as a map of their own"));
}

}  // namespace
}  // namespace psi_slam
