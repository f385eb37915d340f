// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/angle.h"

#include <gtest/gtest.h>

namespace psi_slam {
namespace {

TEST(WrapToPi, gives_the_same_angle_in_the_half_open_interval) {
  for (int i = -4000; i <= 4000; ++i) {
    const double angle = 0.01 * i;
    const double wrapped = wrap_to_pi(angle);
    EXPECT_GT(wrapped, -kPi);
    EXPECT_LE(wrapped, kPi);
    EXPECT_NEAR(std::cos(wrapped), std::cos(angle), 1e-13);
    EXPECT_NEAR(std::sin(wrapped), std::sin(angle), 1e-13);
  }
}

TEST(WrapToPi, takes_half_a_turn_as_positive) {
  EXPECT_EQ(wrap_to_pi(kPi), kPi);
  EXPECT_EQ(wrap_to_pi(-kPi), kPi);
  EXPECT_EQ(wrap_to_pi(3 * kPi), kPi);
}

TEST(WrapToPi, leaves_an_angle_of_the_interval_as_it_is) {
  for (const double angle : {0.0, 1.0, -3.14159, 3.14159, -1e-300}) EXPECT_EQ(wrap_to_pi(angle), angle);
}

}  // namespace
}  // namespace psi_slam
