// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/local_maps/gyroscope_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace psi_slam {
namespace {

constexpr double kStep_s = 0.2;

/// Turns left, right and not at all, ten scans each. `measure` is the gyroscope.
void turn_and_pause(GyroscopeModel& model, int rounds, const std::function<double(double)>& measure) {
  double last_rad = 0;
  for (int i = 0; i < 30 * rounds; ++i) {
    const double turn_rad = 0.2 * (1 - i / 10 % 3);
    model.learn(kStep_s, measure(turn_rad), turn_rad, last_rad);
    last_rad = turn_rad;
  }
}

TEST(GyroscopeModel, learns_a_constant_bias) {
  GyroscopeModel model;
  constexpr double kBias_radps = 0.2;
  turn_and_pause(model, 1, [](double turn_rad) { return turn_rad + kBias_radps * kStep_s; });
  EXPECT_NEAR(model.turn_rad(0.3 + kBias_radps * kStep_s, kStep_s), 0.3, 1e-3);
  EXPECT_TRUE(model.is_credible());
}

TEST(GyroscopeModel, a_wrong_match_hardly_changes_the_bias) {
  GyroscopeModel model;
  turn_and_pause(model, 2, [](double turn_rad) { return turn_rad; });
  model.learn(kStep_s, 0, 3, 0);
  EXPECT_NEAR(model.turn_rad(0, kStep_s), 0, 0.003);
  EXPECT_TRUE(model.is_credible()) << "the match contradicts a constant rate of turn, too";
}

TEST(GyroscopeModel, gyroscopes_with_a_wrong_axis_sign_or_unit_are_not_credible) {
  const std::function<double(double)> faults[] = {[](double) { return 0.0; },
                                                  [](double turn_rad) { return -turn_rad; },
                                                  [](double turn_rad) { return turn_rad * 180 / M_PI; }};
  for (const auto& fault : faults) {
    GyroscopeModel model;
    EXPECT_TRUE(model.is_credible()) << "nothing is known yet";
    turn_and_pause(model, 3, fault);
    EXPECT_FALSE(model.is_credible());
  }
}

}  // namespace
}  // namespace psi_slam
