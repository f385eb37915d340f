// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/loop_consensus.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace psi_slam {
namespace {

using Loops = std::vector<std::size_t>;
using mrpt::math::TPose2D;

// True pose of the front end's frame in the map.
const TPose2D kMapTLocal(2, -1, 0.8);

// Graph with two anchors, which are far apart and have different headings.
PoseGraph two_anchors() {
  PoseGraph graph;
  graph.add_node({0, 0, 0});
  graph.add_node({6, 3, 2.9});
  return graph;
}

// Vote of a robot that moves straight through the front end's frame. The matched pose has an `error` along
// the map's axes.
LoopConsensus::Vote vote(std::size_t loop, double travelled_m, double ambiguity = 0, std::size_t anchor = 0,
                         const TPose2D& error = {0, 0, 0}) {
  LoopConsensus::Vote result;
  result.loop = loop;
  result.travelled_m = travelled_m;
  result.local_T_robot = TPose2D(3, 1, 0.5) + TPose2D(travelled_m, 0, 0);
  result.anchor = anchor;
  const TPose2D map_T_robot = kMapTLocal + result.local_T_robot;
  const TPose2D matched(map_T_robot.x + error.x, map_T_robot.y + error.y, map_T_robot.phi + error.phi);
  result.anchor_T_robot = matched - two_anchors().pose(anchor);
  result.ambiguity = ambiguity;
  return result;
}

TEST(LoopConsensus, one_match_alone_is_never_confirmed) {
  const PoseGraph graph = two_anchors();
  for (const double ambiguity : {0.0, 0.5, 1.0}) {
    LoopConsensus consensus({});
    EXPECT_EQ(consensus.add(vote(0, 5, ambiguity), graph), Loops());
  }
}

TEST(LoopConsensus, two_unambiguous_matches_a_metre_apart_are_confirmed) {
  const PoseGraph graph = two_anchors();
  LoopConsensus consensus({});
  EXPECT_EQ(consensus.add(vote(7, 5), graph), Loops());
  EXPECT_EQ(consensus.add(vote(9, 6.1), graph), Loops({7, 9}));
}

TEST(LoopConsensus, a_search_made_up_for_later_counts_like_one_in_time) {
  const PoseGraph graph = two_anchors();
  LoopConsensus consensus({});
  EXPECT_EQ(consensus.add(vote(9, 6.1), graph), Loops());
  EXPECT_EQ(consensus.add(vote(7, 5), graph), Loops({9, 7}));
}

TEST(LoopConsensus, only_matches_that_still_wait_count) {
  const PoseGraph graph = two_anchors();
  LoopConsensus consensus({});
  consensus.add(vote(7, 5), graph);
  const auto but_7 = [](std::size_t loop) { return loop != 7; };
  EXPECT_EQ(consensus.add(vote(8, 6.1), graph, but_7), Loops());
  EXPECT_EQ(consensus.add(vote(9, 6.2), graph), Loops({7, 8, 9}));
}

TEST(LoopConsensus, matches_from_one_spot_prove_nothing) {
  const PoseGraph graph = two_anchors();
  LoopConsensus consensus({});
  for (std::size_t i = 0; i < 9; ++i)
    EXPECT_EQ(consensus.add(vote(i, 5 + 0.1 * static_cast<double>(i)), graph), Loops()) << i;
  EXPECT_EQ(consensus.add(vote(9, 6.05), graph).size(), 10U);
}

TEST(LoopConsensus, confirmed_matches_are_forgotten) {
  const PoseGraph graph = two_anchors();
  LoopConsensus consensus({});
  consensus.add(vote(0, 5), graph);
  ASSERT_EQ(consensus.add(vote(1, 6.5), graph), Loops({0, 1}));
  EXPECT_EQ(consensus.add(vote(2, 8), graph), Loops());
  EXPECT_EQ(consensus.add(vote(3, 9.5), graph), Loops({2, 3}));
}

// Returns how many matches, 0.6 m apart and with an ambiguity of 0.8, confirm each other. `change` changes
// each match.
template <class Change>
std::size_t needed_matches(const Change& change) {
  const PoseGraph graph = two_anchors();
  LoopConsensus consensus({});
  Loops confirmed;
  for (std::size_t i = 0; i < 10 && confirmed.empty(); ++i) {
    LoopConsensus::Vote match = vote(i, 0.6 * static_cast<double>(i), 0.8);
    change(match);
    confirmed = consensus.add(match, graph);
  }
  return confirmed.size();
}

TEST(LoopConsensus, weak_matches_need_more_others_than_strong_ones) {
  const auto needed = [](double response) {
    return needed_matches([&](LoopConsensus::Vote& match) { match.response = response; });
  };
  EXPECT_EQ(needed(0.9), 3U);  // 3 * 0.2 is more than 0.5
  EXPECT_EQ(needed(0.6), 3U);
  EXPECT_EQ(needed(0.5), 4U);  // 0.2 * (0.5 / 0.6)^2 = 0.14
  EXPECT_EQ(needed(0.4), 6U);  // 0.2 * (0.4 / 0.6)^2 = 0.09
}

TEST(LoopConsensus, two_weak_matches_suffice_where_no_other_place_is_similar) {
  const PoseGraph graph = two_anchors();
  LoopConsensus consensus({});
  for (std::size_t i = 0; i < 2; ++i) {
    LoopConsensus::Vote match = vote(i, 1.1 * static_cast<double>(i));
    match.response = 0.35;
    EXPECT_EQ(consensus.add(match, graph).size(), 2 * i);
  }
}

TEST(LoopConsensus, one_strong_match_needs_more_than_a_weak_one) {
  const PoseGraph graph = two_anchors();
  LoopConsensus consensus({});
  EXPECT_EQ(consensus.add(vote(0, 5, 0.9), graph), Loops());
  EXPECT_EQ(consensus.add(vote(1, 6.5, 0), graph), Loops()) << "1.1 in sum, but 1.0 by one match";
  EXPECT_EQ(consensus.add(vote(2, 7.5, 0.8), graph), Loops({0, 1, 2})) << "0.1 + 0.2 + half of 0.5";
}

TEST(LoopConsensus, matches_far_from_the_prediction_need_more_others) {
  const auto needed = [](double prior) {
    return needed_matches([&](LoopConsensus::Vote& match) { match.prior = prior; });
  };
  EXPECT_EQ(needed(1), 3U);
  EXPECT_EQ(needed(0.5), 6U) << "0.1 each, within 4 m";
}

// These matches of a simulated log led to another corridor, 15 m off. The true corridor was not searched.
TEST(LoopConsensus, weak_matches_in_an_equal_corridor_confirm_none) {
  struct Match {
    double ambiguity;
    double response;
  };
  const PoseGraph graph = two_anchors();
  LoopConsensus consensus({});
  double travelled_m = 0;
  for (const Match& one : {Match{0.93, 0.39}, Match{0.78, 0.39}, Match{0.96, 0.40}, Match{0.76, 0.43},
                           Match{0.95, 0.50}, Match{0.85, 0.47}}) {
    LoopConsensus::Vote match = vote(0, travelled_m += 0.5, one.ambiguity);
    match.response = one.response;
    EXPECT_EQ(consensus.add(match, graph), Loops()) << travelled_m;
  }
}

TEST(LoopConsensus, ambiguous_matches_need_many_others) {
  const PoseGraph graph = two_anchors();
  LoopConsensus consensus({});
  std::size_t votes = 0;
  Loops confirmed;
  while (confirmed.empty() && votes < 30) {
    confirmed =
        consensus.add(vote(votes, 0.35 * static_cast<double>(votes), 0.9499), graph);  // weighs 0.0501
    ++votes;
  }
  EXPECT_GE(votes, 9U);
  EXPECT_LE(votes, 11U);
  EXPECT_EQ(confirmed.size(), votes);
}

TEST(LoopConsensus, matches_that_fit_another_place_as_well_prove_nothing_together) {
  const PoseGraph graph = two_anchors();
  for (const double ambiguity : {0.96, 1.0}) {
    LoopConsensus consensus({});
    for (std::size_t i = 0; i < 60; ++i)
      ASSERT_EQ(consensus.add(vote(i, 0.25 * static_cast<double>(i), ambiguity), graph), Loops());
  }
}

TEST(LoopConsensus, a_match_that_fits_another_place_as_well_confirms_no_single_match) {
  const PoseGraph graph = two_anchors();
  LoopConsensus consensus({});
  EXPECT_EQ(consensus.add(vote(0, 5, 1.0), graph), Loops());
  EXPECT_EQ(consensus.add(vote(1, 6.5, 0), graph), Loops());
  EXPECT_EQ(consensus.add(vote(2, 7.6, 0), graph), Loops({0, 1, 2}));
}

TEST(LoopConsensus, matches_of_different_places_do_not_add_up) {
  const PoseGraph graph = two_anchors();
  for (const TPose2D& error : {TPose2D(0.6, 0, 0), TPose2D(0, -0.6, 0), TPose2D(0, 0, 0.1)}) {
    LoopConsensus consensus({});
    consensus.add(vote(0, 5), graph);
    EXPECT_EQ(consensus.add(vote(1, 6.5, 0, 0, error), graph), Loops()) << error.asString();
  }
  for (const TPose2D& error : {TPose2D(0.4, 0, 0), TPose2D(0, -0.4, 0), TPose2D(0, 0, 0.05)}) {
    LoopConsensus consensus({});
    consensus.add(vote(0, 5), graph);
    EXPECT_EQ(consensus.add(vote(1, 6.5, 0, 0, error), graph), Loops({0, 1})) << error.asString();
  }
}

TEST(LoopConsensus, another_place_blocks_until_it_is_outweighed) {
  const PoseGraph graph = two_anchors();
  LoopConsensus consensus({});
  EXPECT_EQ(consensus.add(vote(0, 5.0, 0.4, 0, {3, 0, 0}), graph), Loops());  // this wrong place weighs 0.6
  EXPECT_EQ(consensus.add(vote(1, 5.2, 0.5), graph), Loops());
  EXPECT_EQ(consensus.add(vote(2, 6.5, 0.5), graph), Loops()) << "0.6 against 1.0";
  EXPECT_EQ(consensus.add(vote(3, 7.5, 0.5), graph), Loops({1, 2, 3})) << "0.6 against 1.5";
}

TEST(LoopConsensus, scattered_other_places_do_not_block_together) {
  const PoseGraph graph = two_anchors();
  LoopConsensus consensus({});
  for (std::size_t i = 0; i < 4; ++i)  // four matches, each at a different wrong place
    consensus.add(vote(i, 5.0, 0.6, 0, {3.0 + 2.0 * static_cast<double>(i), 0, 0}), graph);
  consensus.add(vote(4, 5.2, 0.5), graph);
  EXPECT_EQ(consensus.add(vote(5, 6.5, 0.5), graph), Loops({4, 5}));
}

TEST(LoopConsensus, old_matches_are_forgotten) {
  const PoseGraph graph = two_anchors();
  LoopConsensusOptions options;
  options.memory_m = 15;
  LoopConsensus late(options);
  late.add(vote(0, 5), graph);
  EXPECT_EQ(late.add(vote(1, 20.5), graph), Loops());
  LoopConsensus in_time(options);
  in_time.add(vote(0, 5), graph);
  EXPECT_EQ(in_time.add(vote(1, 19.5), graph), Loops({0, 1}));
}

TEST(LoopConsensus, old_matches_of_another_place_do_not_block) {
  const PoseGraph graph = two_anchors();
  LoopConsensus consensus({});
  consensus.add(vote(0, 5, 0, 0, {3, 0, 0}), graph);
  consensus.add(vote(1, 7.5, 0.5), graph);
  EXPECT_EQ(consensus.add(vote(2, 8.9, 0.5), graph), Loops()) << "the other place is 3.9 m back";
  EXPECT_EQ(consensus.add(vote(3, 9.1, 0.9), graph), Loops({1, 2, 3})) << "the other place is 4.1 m back";
}

// Matches that are off by the same number of equal doors agree along the whole corridor. In MIT Killian
// they were this ambiguous and about this far apart.
TEST(LoopConsensus, a_few_ambiguous_matches_along_a_corridor_confirm_nothing) {
  const PoseGraph graph = two_anchors();
  const auto confirms = [&](double step_m) {
    LoopConsensus consensus({});
    const std::vector<double> ambiguities = {0.89, 0.80, 0.83, 0.90};
    for (std::size_t i = 0; i < ambiguities.size(); ++i)
      if (!consensus.add(vote(i, 5 + static_cast<double>(i) * step_m, ambiguities[i]), graph).empty())
        return true;
    return false;
  };
  EXPECT_FALSE(confirms(1.5));
  EXPECT_TRUE(confirms(0.5)) << "as densely as true matches follow each other";
}

TEST(LoopConsensus, matches_with_different_anchors_agree_about_one_place) {
  const PoseGraph graph = two_anchors();
  LoopConsensus same({});
  same.add(vote(0, 5, 0, 0), graph);
  EXPECT_EQ(same.add(vote(1, 6.5, 0, 1), graph), Loops({0, 1}));
  LoopConsensus other({});
  other.add(vote(0, 5, 0, 0), graph);
  EXPECT_EQ(other.add(vote(1, 6.5, 0, 1, {0, 1, 0}), graph), Loops());
}

TEST(LoopConsensus, uses_the_present_poses_of_anchors) {
  PoseGraph moved = two_anchors();
  LoopConsensus consensus({});
  consensus.add(vote(0, 5, 0.2, 0), moved);
  consensus.add(vote(1, 5, 0, 1), moved);
  moved.set_pose(0, {2, 0, 0});  // moves the places of all matches with anchor 0
  EXPECT_EQ(consensus.add(vote(2, 6.5, 0, 0), moved), Loops()) << "the match with anchor 1 now disagrees";
  EXPECT_EQ(consensus.add(vote(3, 7.5, 0, 0), moved), Loops({0, 2, 3}));

  PoseGraph joined = two_anchors();
  LoopConsensus apart({});
  apart.add(vote(0, 5, 0, 0, {2, 0, 0}), joined);
  joined.set_pose(0, {-2, 0, 0});  // compensates the error of the first match
  EXPECT_EQ(apart.add(vote(1, 6.5, 0, 1), joined), Loops({0, 1}));
}

TEST(LoopConsensus, headings_agree_across_the_turn_from_pi_to_minus_pi) {
  PoseGraph graph;
  graph.add_node({0, 0, 0});
  LoopConsensus consensus({});
  LoopConsensus::Vote first;
  first.loop = 0;
  first.anchor_T_robot = {1, 1, M_PI - 0.02};
  LoopConsensus::Vote second;
  second.loop = 1;
  second.travelled_m = 1.5;
  second.local_T_robot = {1.5, 0, 0};
  second.anchor_T_robot = {-0.5, 1, -M_PI + 0.02};
  consensus.add(first, graph);
  EXPECT_EQ(consensus.add(second, graph), Loops({0, 1}));
}

}  // namespace
}  // namespace psi_slam
