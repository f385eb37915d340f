// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/wide_search_schedule.h"

#include <algorithm>
#include <tuple>

namespace psi_slam {

std::vector<LoopCandidate> WideSearchSchedule::choose(std::vector<LoopCandidate> candidates,
                                                      std::size_t count) const {
  if (candidates.size() > count) {
    const auto rank = [&](const LoopCandidate& candidate) {
      const Search search = last(candidate.local_map);
      const bool promising = search.found && search.number != searches_ && !was_preferred_;
      return std::tuple(!promising, search.number, candidate.distance_m, candidate.local_map);
    };
    std::sort(candidates.begin(), candidates.end(),
              [&](const LoopCandidate& a, const LoopCandidate& b) { return rank(a) < rank(b); });
    candidates.resize(count);
  }
  std::sort(candidates.begin(), candidates.end(),
            [](const LoopCandidate& a, const LoopCandidate& b) { return a.local_map < b.local_map; });
  return candidates;
}

void WideSearchSchedule::searched(std::size_t local_map, bool found) {
  was_preferred_ = last(local_map).found;
  last_[local_map] = {++searches_, found};
}

}  // namespace psi_slam
