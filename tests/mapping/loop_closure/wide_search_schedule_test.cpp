// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/wide_search_schedule.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace psi_slam {
namespace {

using Maps = std::vector<std::size_t>;

// Returns candidates with the local maps 0, 1, 2, ...; local maps with higher numbers are nearer.
std::vector<LoopCandidate> candidates(std::size_t count) {
  std::vector<LoopCandidate> result(count);
  for (std::size_t m = 0; m < count; ++m) {
    result[m].local_map = m;
    result[m].distance_m = static_cast<double>(count - m);
  }
  return result;
}

Maps choose(const WideSearchSchedule& schedule, std::size_t of, std::size_t count) {
  Maps chosen;
  for (const LoopCandidate& candidate : schedule.choose(candidates(of), count))
    chosen.push_back(candidate.local_map);
  return chosen;
}

TEST(WideSearchSchedule, chooses_the_nearest_first) {
  EXPECT_EQ(choose({}, 7, 3), Maps({4, 5, 6}));
}

TEST(WideSearchSchedule, chooses_all_if_a_node_may_search_them) {
  EXPECT_EQ(choose({}, 3, 3), Maps({0, 1, 2}));
  EXPECT_EQ(choose({}, 0, 3), Maps());
}

TEST(WideSearchSchedule, searches_every_local_map_in_turn) {
  WideSearchSchedule schedule;
  std::set<std::size_t> searched;
  for (int node = 0; node < 4; ++node) {
    for (const std::size_t m : choose(schedule, 8, 2)) {
      EXPECT_TRUE(searched.insert(m).second) << "local map " << m << " was searched before others";
      schedule.searched(m, false);
    }
  }
  EXPECT_EQ(searched.size(), 8U);
  EXPECT_EQ(choose(schedule, 8, 2), Maps({6, 7})) << "searched longest ago";
}

TEST(WideSearchSchedule, searches_again_where_it_found_a_match) {
  WideSearchSchedule schedule;
  schedule.searched(1, true);
  schedule.searched(6, false);
  EXPECT_EQ(choose(schedule, 8, 2), Maps({1, 7}));
  schedule.searched(1, true);
  EXPECT_EQ(choose(schedule, 8, 1), Maps({7})) << "the local map of the very last search is not preferred";
  schedule.searched(1, false);
  EXPECT_EQ(choose(schedule, 8, 2), Maps({5, 7})) << "local map 1 found no match again and is not preferred";
}

TEST(WideSearchSchedule, searches_every_local_map_although_two_always_have_matches) {
  WideSearchSchedule schedule;
  std::set<std::size_t> searched;
  for (int node = 0; node < 16; ++node) {
    for (const std::size_t m : choose(schedule, 8, 1)) {
      searched.insert(m);
      schedule.searched(m, m >= 6);  // the two nearest
    }
  }
  EXPECT_EQ(searched.size(), 8U);
}

}  // namespace
}  // namespace psi_slam
