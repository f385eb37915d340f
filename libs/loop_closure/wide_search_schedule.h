// SPDX-License-Identifier: BSD-3-Clause
// Spreads searches in wide windows over the nodes. One such search costs as much as ten in narrow windows,
// and a robot whose position is uncertain by metres has many local maps around it. Each node searches a few
// of them, and the next nodes the others, so that a node's cost is bounded and no local map is forgotten.
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "loop_closure/loop_candidates.h"

namespace psi_slam {

class WideSearchSchedule {
 public:
  /// At most `count` of these candidates, by ascending local map. Prefers those whose last search found a
  /// match, because others must agree with it, but not the one searched last of all, so that other places get
  /// their turn; then those not searched for longest; then the nearest.
  std::vector<LoopCandidate> choose(std::vector<LoopCandidate> candidates, std::size_t count) const;

  /// Tells the outcome of a search with a local map.
  void searched(std::size_t local_map, bool found) { last_[local_map] = {++searches_, found}; }

 private:
  struct Search {
    std::size_t number = 0;  ///< counts from 1; 0: never
    bool found = false;
  };
  Search last(std::size_t local_map) const {
    const auto search = last_.find(local_map);
    return search == last_.end() ? Search() : search->second;
  }

  std::map<std::size_t, Search> last_;  ///< by local map
  std::size_t searches_ = 0;
};

}  // namespace psi_slam
