// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/mapping_result.h"

#include <algorithm>
#include <numeric>

namespace psi_slam {

std::vector<FrameSpan> runs_of(std::size_t frames, const std::vector<std::size_t>& later_run_frames) {
  std::vector<FrameSpan> runs{{0, frames}};
  for (const std::size_t begin : later_run_frames) {
    runs.back().end = begin;
    runs.push_back({begin, frames});
  }
  return runs;
}

std::vector<FrameSpan> runs_of(const MappingResult& result) {
  return runs_of(result.frames.size(), result.later_run_frames);
}

std::vector<FrameSpan> logs_of(const MappingResult& result) {
  std::vector<std::size_t> begins;
  for (const std::size_t begin : result.later_run_frames)
    if (std::none_of(result.interruptions.begin(), result.interruptions.end(),
                     [&](const Interruption& one) { return one.frame == begin; }))
      begins.push_back(begin);
  return runs_of(result.frames.size(), begins);
}

std::optional<std::size_t> unjoined_log(const MappingResult& result) {
  const auto run_of_node = [&](std::size_t node) {
    const auto& begins = result.later_run_frames;
    const auto next = std::upper_bound(begins.begin(), begins.end(), result.node_frames[node]);
    return static_cast<std::size_t>(next - begins.begin());
  };
  // For each run, the lowest number of a run joined to it by loops.
  std::vector<std::size_t> group(result.later_run_frames.size() + 1);
  std::iota(group.begin(), group.end(), 0U);
  for (const LoopRecord& loop : result.loops) {
    if (loop.state != LoopState::kAccepted) continue;
    const auto [low, high] = std::minmax({group[run_of_node(loop.node)], group[run_of_node(loop.anchor)]});
    std::replace(group.begin(), group.end(), high, low);
  }
  const std::vector<FrameSpan> logs = logs_of(result);
  for (std::size_t log = 1; log < logs.size(); ++log) {
    const auto& begins = result.later_run_frames;
    const auto run = std::lower_bound(begins.begin(), begins.end(), logs[log].begin) - begins.begin() + 1;
    if (group[static_cast<std::size_t>(run)] != 0) return log;
  }
  return std::nullopt;
}

}  // namespace psi_slam
