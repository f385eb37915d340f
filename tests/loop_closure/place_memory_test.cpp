// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/loop_closure/place_memory.h"

#include <gtest/gtest.h>

#include <vector>

namespace psi_slam {
namespace {

std::vector<std::size_t> first_of_stretches(const std::vector<double>& travelled_m, double stretch_m) {
  std::vector<NodeScan> nodes(travelled_m.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i].travelled_m = travelled_m[i];
  std::vector<std::size_t> first;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (begins_stretch(i, nodes, stretch_m)) first.push_back(i);
  return first;
}

TEST(BeginsStretch, once_in_each_stretch) {
  EXPECT_EQ(first_of_stretches({0, 0.2, 0.4, 0.6, 0.8, 1.0, 1.1}, 0.5), (std::vector<std::size_t>{0, 3, 5}));
}

TEST(BeginsStretch, all_nodes_when_they_are_farther_apart) {
  EXPECT_EQ(first_of_stretches({0, 0.7, 1.2, 3.1}, 0.5), (std::vector<std::size_t>{0, 1, 2, 3}));
}

TEST(BeginsStretch, all_nodes_when_stretches_have_no_length) {
  EXPECT_EQ(first_of_stretches({0, 0, 0.1}, 0), (std::vector<std::size_t>{0, 1, 2}));
}

TEST(BeginsStretch, not_again_while_the_robot_turns_on_the_spot) {
  EXPECT_EQ(first_of_stretches({0, 0.6, 0.6, 0.6, 0.6}, 0.5), (std::vector<std::size_t>{0, 1}));
}

}  // namespace
}  // namespace psi_slam
