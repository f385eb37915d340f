// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/mapping/mapping_result.h"

#include <algorithm>

namespace psi_slam {

std::vector<FrameSpan> drives_of(const MappingResult& result) {
  std::vector<FrameSpan> drives{{0, result.frames.size()}};
  for (const std::size_t begin : result.drive_frames) {
    drives.back().end = begin;
    drives.push_back({begin, result.frames.size()});
  }
  return drives;
}

std::optional<std::size_t> unjoined_drive(const MappingResult& result) {
  const auto drive_of_node = [&](std::size_t node) {
    const auto& begins = result.drive_frames;
    return std::upper_bound(begins.begin(), begins.end(), result.node_frames[node]) - begins.begin();
  };
  std::vector<bool> joined(result.drive_frames.size() + 1, result.drive_frames.empty());
  for (const LoopRecord& loop : result.loops) {
    const auto here = drive_of_node(loop.node);
    const auto there = drive_of_node(loop.anchor);
    if (loop.verdict != LoopVerdict::kAccepted || here == there) continue;
    joined[static_cast<std::size_t>(here)] = true;
    joined[static_cast<std::size_t>(there)] = true;
  }
  const auto unjoined = std::find(joined.begin(), joined.end(), false);
  if (unjoined == joined.end()) return std::nullopt;
  return static_cast<std::size_t>(unjoined - joined.begin());
}

}  // namespace psi_slam
