// SPDX-License-Identifier: BSD-3-Clause
#include "map/exports/interruptions.h"

#include <algorithm>
#include <cmath>

#include "base/number_text.h"

namespace psi_slam {

std::vector<std::string> interruption_texts(const MappingResult& result) {
  std::vector<std::string> texts;
  const std::vector<FrameSpan> logs = logs_of(result);
  const auto since_start = [&](std::size_t frame) {
    const auto log =
        std::find_if(logs.rbegin(), logs.rend(), [&](const FrameSpan& one) { return one.begin <= frame; });
    const TimeUs since_us = result.frames[frame].time_us - result.frames[log->begin].time_us;
    return minutes_text(std::floor(seconds(since_us)));
  };
  for (const Interruption& interruption : result.interruptions) {
    const std::string lost = "the place of the robot was lost between " +
                             since_start(interruption.frame - 1) + " and " + since_start(interruption.frame);
    if (interruption.found_frame)
      texts.push_back(lost + ", and found again at " + since_start(*interruption.found_frame));
    else
      texts.push_back(lost +
                      ", and was not found again: the scans from there on are drawn beside the map, as a map "
                      "of their own");
  }
  return texts;
}

}  // namespace psi_slam
