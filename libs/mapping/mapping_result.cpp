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

std::optional<std::size_t> unjoined_run(const MappingResult& result) {
  const auto run_of_node = [&](std::size_t node) {
    const auto& begins = result.later_run_frames;
    const auto next = std::upper_bound(begins.begin(), begins.end(), result.node_frames[node]);
    return static_cast<std::size_t>(next - begins.begin());
  };
  // For each run, the lowest number of a run joined to it by loops.
  std::vector<std::size_t> group(result.later_run_frames.size() + 1);
  std::iota(group.begin(), group.end(), 0U);
  for (const LoopRecord& loop : result.loops) {
    if (loop.verdict != LoopVerdict::kAccepted) continue;
    const auto [low, high] = std::minmax({group[run_of_node(loop.node)], group[run_of_node(loop.anchor)]});
    std::replace(group.begin(), group.end(), high, low);
  }
  const auto unjoined = std::find_if(group.begin(), group.end(), [](std::size_t run) { return run != 0; });
  if (unjoined == group.end()) return std::nullopt;
  return static_cast<std::size_t>(unjoined - group.begin());
}

}  // namespace psi_slam
