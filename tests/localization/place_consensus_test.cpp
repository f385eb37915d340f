// SPDX-License-Identifier: BSD-3-Clause
#include "localization/place_consensus.h"

#include <gtest/gtest.h>

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

/// A straight path with a node every metre.
KeyframeStore straight_keyframes(std::size_t nodes) {
  KeyframeStore keyframes;
  for (std::size_t node = 0; node < nodes; ++node) {
    NodeScan scan;
    scan.travelled_m = static_cast<double>(node);
    scan.local_T_robot = {scan.travelled_m, 0, 0};
    keyframes.nodes.push_back(scan);
  }
  return keyframes;
}

FoundPlace found_at(const TPose2D& map_T_robot) {
  FoundPlace place;
  place.map_T_robot = map_T_robot;
  return place;
}

/// Adds a place at each node. Returns whether one of them was agreed on.
bool agree(const std::vector<TPose2D>& places) {
  const KeyframeStore keyframes = straight_keyframes(places.size());
  PlaceConsensus consensus{LoopConsensusOptions()};
  bool agreed = false;
  for (std::size_t node = 0; node < places.size(); ++node)
    agreed = consensus.add(node, keyframes, found_at(places[node])) || agreed;
  return agreed;
}

TEST(PlaceConsensus, believes_places_that_fit_the_path_between_them) {
  std::vector<TPose2D> places;
  for (int i = 0; i < 20; ++i) places.emplace_back(5.0 + i, 3.0, 0.0);
  EXPECT_TRUE(agree(places));
  EXPECT_FALSE(agree({places.front()})) << "one place has no witness";
}

TEST(PlaceConsensus, believes_places_that_nearly_fit_elsewhere_if_there_are_many) {
  const KeyframeStore keyframes = straight_keyframes(20);
  PlaceConsensus consensus{LoopConsensusOptions()};
  std::size_t searches = 0;
  for (std::size_t node = 0; node < 20; node += 2) {  // a prior map is searched every 2 m
    FoundPlace place = found_at({5.0 + static_cast<double>(node), 3.0, 0.0});
    place.ambiguity = 0.86;
    ++searches;
    if (consensus.add(node, keyframes, place)) break;
  }
  EXPECT_EQ(searches, 4U) << "weights of 0.14 add up to 0.5";
}

TEST(PlaceConsensus, does_not_believe_places_that_contradict_each_other) {
  std::vector<TPose2D> places;
  for (int i = 0; i < 20; ++i) places.emplace_back(5.0 + 7 * (i % 5) * i, 3.0 * i * i, 0.4 * i);
  EXPECT_FALSE(agree(places));
}

}  // namespace
}  // namespace psi_slam
