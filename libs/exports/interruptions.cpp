// SPDX-License-Identifier: BSD-3-Clause
#include "exports/interruptions.h"

#include <mrpt/core/format.h>

#include <algorithm>
#include <cmath>

namespace psi_slam {
namespace {

/// Text of a time such as "3:07".
std::string minutes_text(double time_s) {
  const auto whole_s = static_cast<long>(std::floor(time_s));
  return mrpt::format("%ld:%02ld", whole_s / 60, whole_s % 60);
}

}  // namespace

std::vector<std::string> interruption_texts(const MappingResult& result) {
  std::vector<std::string> texts;
  const std::vector<FrameSpan> logs = logs_of(result);
  const auto since_start = [&](std::size_t frame) {
    const auto log =
        std::find_if(logs.rbegin(), logs.rend(), [&](const FrameSpan& one) { return one.begin <= frame; });
    return minutes_text(seconds(result.frames[frame].time_us - result.frames[log->begin].time_us));
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
