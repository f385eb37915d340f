// SPDX-License-Identifier: BSD-3-Clause
#include "map/report/drawn_loops.h"

#include <algorithm>
#include <map>
#include <utility>

namespace psi_slam {

std::vector<std::size_t> drawn_loops(const std::vector<LoopRecord>& loops) {
  struct Sampling {
    std::size_t count = 0;
    std::size_t seen = 0;
  };
  std::map<std::pair<LoopState, bool>, Sampling> samplings;
  const auto sampling_of = [&](const LoopRecord& loop) -> Sampling& {
    return samplings[{loop.state, is_outlier(loop)}];
  };
  for (const LoopRecord& loop : loops)
    if (!loop.by_hand && !found_nothing(loop)) ++sampling_of(loop).count;
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (found_nothing(loops[i])) continue;
    bool drawn = true;
    if (!loops[i].by_hand) {
      auto& [count, seen] = sampling_of(loops[i]);
      const std::size_t most = std::min(count, kMaxLoopsDrawn);
      drawn = seen * most / count != (seen + 1) * most / count;
      ++seen;
    }
    if (drawn) chosen.push_back(i);
  }
  return chosen;
}

}  // namespace psi_slam
