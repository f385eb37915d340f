// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/beam_directions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

namespace psi_slam {
namespace {

BeamBearings bearings(const std::vector<float>& values_rad) {
  return std::make_shared<const std::vector<float>>(values_rad);
}

void expect_directions_of(const std::vector<float>& values_rad, const BeamDirections& directions) {
  ASSERT_EQ(directions->size(), values_rad.size());
  for (std::size_t i = 0; i < values_rad.size(); ++i) {
    EXPECT_NEAR((*directions)[i].x, std::cos(static_cast<double>(values_rad[i])), 1e-15);
    EXPECT_NEAR((*directions)[i].y, std::sin(static_cast<double>(values_rad[i])), 1e-15);
  }
}

TEST(BeamDirections, are_those_of_the_bearings) {
  const std::vector<float> values_rad{-3.5F, -1, 0, 0.5F, 4};
  expect_directions_of(values_rad, beam_directions(bearings(values_rad)));
  EXPECT_TRUE(beam_directions(nullptr)->empty());
  EXPECT_TRUE(beam_directions(bearings({}))->empty());
}

TEST(BeamDirections, are_computed_once_for_the_scans_of_a_few_lasers) {
  const BeamBearings front = bearings({-1, 0, 1});
  const BeamBearings back = bearings({2, 3, 4});
  const BeamDirections of_front = beam_directions(front);
  const BeamDirections of_back = beam_directions(back);
  EXPECT_EQ(beam_directions(front), of_front);
  EXPECT_EQ(beam_directions(back), of_back);
}

TEST(BeamDirections, of_many_lasers_in_turn_stay_right) {
  std::vector<BeamDirections> kept;
  for (int round = 0; round < 2; ++round)
    for (int laser = 0; laser < 10; ++laser) {
      const std::vector<float> values_rad{static_cast<float>(laser), static_cast<float>(laser + round)};
      kept.push_back(beam_directions(bearings(values_rad)));
      expect_directions_of(values_rad, kept.back());
    }
  expect_directions_of({0, 0}, kept.front());  // still valid
  EXPECT_TRUE(beam_directions(nullptr)->empty());
}

}  // namespace
}  // namespace psi_slam
