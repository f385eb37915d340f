// SPDX-License-Identifier: BSD-3-Clause
#include "match/loop_cases.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "office_log.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

std::set<std::pair<std::size_t, std::size_t>> pairs_of(const std::vector<LoopCase>& cases) {
  std::set<std::pair<std::size_t, std::size_t>> pairs;
  for (const LoopCase& one : cases) pairs.emplace(one.node, one.local_map);
  return pairs;
}

double nearest_node_m(const LoopCase& one) {
  const PlacedLocalMap& map = office_log().memory.local_maps[one.local_map];
  double nearest = 1e9;
  for (std::size_t node = map.first_node; node <= map.last_node; ++node) {
    const TPose2D& there = office_log().map_T_node[node];
    const TPose2D& here = office_log().map_T_node[one.node];
    nearest = std::min(nearest, std::hypot(there.x - here.x, there.y - here.y));
  }
  return nearest;
}

TEST(LoopCases, have_both_kinds_and_no_pair_twice) {
  const std::vector<LoopCase> cases = draw_cases(office_log(), office_cases());
  ASSERT_EQ(cases.size(), 24U);
  EXPECT_EQ(pairs_of(cases).size(), 24U);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    EXPECT_EQ(cases[i].positive, i < 12);
    EXPECT_EQ(cases[i].seed.run, 1U);
    EXPECT_EQ(cases[i].seed.scan, office_log().memory.nodes[cases[i].node].frame);
    EXPECT_EQ(cases[i].seed.local_map, office_log().memory.local_maps[cases[i].local_map].id);
  }
}

TEST(LoopCases, positive_cases_share_space_seen_at_another_time) {
  const CaseOptions options = office_cases();
  for (const LoopCase& one : draw_cases(office_log(), options)) {
    if (!one.positive) continue;
    const PlacedLocalMap& map = office_log().memory.local_maps[one.local_map];
    const auto& nodes = office_log().memory.nodes;
    const double travel_m = one.node > map.last_node
                                ? nodes[one.node].travelled_m - nodes[map.last_node].travelled_m
                                : nodes[map.first_node].travelled_m - nodes[one.node].travelled_m;
    EXPECT_GE(travel_m, 10);
    EXPECT_LE(nearest_node_m(one), 1.5);
    const LocalMap::Agreement agreement = one.map->agreement(*one.scan, one.anchor_T_node);
    EXPECT_GE(static_cast<double>(agreement.observed), 0.7 * static_cast<double>(one.scan->points.size()));
    EXPECT_GE(agreement.share(), 0.8);
  }
}

TEST(LoopCases, positive_starts_keep_the_truth_inside_the_window) {
  CaseOptions options = office_cases();
  options.count = 200;
  double farthest_m = 0;
  double most_turned = 0;
  for (const LoopCase& one : draw_cases(office_log(), options)) {
    if (!one.positive) continue;
    farthest_m = std::max(farthest_m,
                          std::hypot(one.start.x - one.anchor_T_node.x, one.start.y - one.anchor_T_node.y));
    most_turned =
        std::max(most_turned, std::abs(std::remainder(one.start.phi - one.anchor_T_node.phi, 2 * M_PI)));
  }
  EXPECT_LE(farthest_m, 0.75 + 1e-9);
  EXPECT_GT(farthest_m, 0.65);
  EXPECT_LE(most_turned, 0.25 + 1e-9);
  EXPECT_GT(most_turned, 0.22);
}

TEST(LoopCases, negative_cases_are_outside_the_window) {
  const CaseOptions options = office_cases();
  for (const LoopCase& one : draw_cases(office_log(), options)) {
    if (one.positive) continue;
    EXPECT_GT(nearest_node_m(one), options.window_m + options.clear_m);
  }
}

TEST(LoopCases, depend_on_the_seed_alone) {
  CaseOptions options = office_cases();
  const auto first = draw_cases(office_log(), options);
  const auto again = draw_cases(office_log(), options);
  ASSERT_EQ(first.size(), again.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].node, again[i].node);
    EXPECT_EQ(first[i].local_map, again[i].local_map);
    EXPECT_EQ(first[i].start.x, again[i].start.x);
    EXPECT_EQ(first[i].start.phi, again[i].start.phi);
  }
  options.seed = 2;
  EXPECT_NE(pairs_of(draw_cases(office_log(), options)), pairs_of(first));
}

TEST(LoopCases, have_the_same_pairs_in_windows_of_all_sizes) {
  CaseOptions options = office_cases();
  const auto narrow = draw_cases(office_log(), options);
  options.window_m += 1;
  options.clear_m -= 1;
  const auto wide = draw_cases(office_log(), options);
  ASSERT_EQ(narrow.size(), wide.size());
  for (std::size_t i = 0; i < narrow.size(); ++i) {
    EXPECT_EQ(narrow[i].node, wide[i].node);
    EXPECT_EQ(narrow[i].local_map, wide[i].local_map);
  }
}

TEST(LoopCases, are_fewer_if_the_log_has_no_more) {
  CaseOptions options = office_cases();
  options.clear_m = 100;
  const auto cases = draw_cases(office_log(), options);
  EXPECT_EQ(cases.size(), 12U);
  EXPECT_TRUE(cases.back().positive);
}

TEST(LoopCases, a_context_contains_earlier_scans) {
  CaseOptions options = office_cases();
  options.context = true;
  const auto cases = draw_cases(office_log(), options);
  ASSERT_FALSE(cases.empty());
  for (const LoopCase& one : cases) {
    if (office_log().memory.nodes[one.node].travelled_m < 5) continue;
    EXPECT_GT(one.scan->points.size(), office_log().memory.nodes[one.node].points->points.size());
  }
}

}  // namespace
}  // namespace psi_slam
