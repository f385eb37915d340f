// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/wide_search_schedule.h"

#include <algorithm>
#include <tuple>

namespace psi_slam {

std::vector<LoopCandidate> WideSearchSchedule::choose(std::vector<LoopCandidate> candidates,
                                                      std::size_t count) const {
  if (candidates.size() > count) {
    const auto rank = [&](const LoopCandidate& candidate) {
      const Search search = last(candidate.local_map);
      const bool promising = search.found && search.number != searches_;
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

}  // namespace psi_slam
