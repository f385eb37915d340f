// SPDX-License-Identifier: BSD-3-Clause
// Distributes searches in wide windows over the nodes. Such a search costs as much as ten in narrow windows,
// and a robot whose position is uncertain by metres has many candidates. Each node searches only a few local
// maps; the next nodes search the remaining ones. This bounds the cost of a node, and every local map gets
// its turn.
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "mapping/loop_closure/loop_candidates.h"

namespace psi_slam {

class WideSearchSchedule {
 public:
  /// Returns at most `count` of the candidates, in ascending order of local maps. First come local maps whose
  /// last search found a match, because further matches must agree with it. Of two successive searches, only
  /// one prefers such a local map, so the others get their turn. Then come local maps not searched for
  /// longest, then the nearest.
  std::vector<LoopCandidate> choose(std::vector<LoopCandidate> candidates, std::size_t count) const;

  /// Records the outcome of a search in a local map.
  void searched(std::size_t local_map, bool found);

 private:
  struct Search {
    std::size_t number = 0;  ///< number of the search, from 1; 0: never searched
    bool found = false;
  };
  Search last(std::size_t local_map) const {
    const auto search = last_.find(local_map);
    return search == last_.end() ? Search() : search->second;
  }

  std::map<std::size_t, Search> last_;  ///< last search of each local map
  std::size_t searches_ = 0;
  bool was_preferred_ = false;  ///< whether the last search was in a local map with an earlier match
};

}  // namespace psi_slam
