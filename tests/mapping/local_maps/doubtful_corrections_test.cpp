// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/local_maps/doubtful_corrections.h"

#include <gtest/gtest.h>

namespace psi_slam {
namespace {

using Eigen::Vector2d;

// Returns the outcome of a step of 0.1 m, with a standard deviation of 0.01 m.
bool applies(DoubtfulCorrections& corrections, double correction_m) {
  corrections.moved(0.1, 0.01);
  return corrections.add_doubtful(Vector2d(correction_m, 0));
}

// Makes 500 such steps with supported corrections.
void support(DoubtfulCorrections& corrections, double correction_m) {
  for (int i = 0; i < 500; ++i) {
    corrections.moved(0.1, 0.01);
    corrections.add_supported(correction_m);
  }
}

TEST(DoubtfulCorrections, apply_what_errors_of_odometry_explain) {
  DoubtfulCorrections corrections({3, 1, 10});
  EXPECT_TRUE(applies(corrections, 0.029));
  EXPECT_TRUE(applies(corrections, -0.029));
  EXPECT_FALSE(applies(corrections, 0.031));
}

TEST(DoubtfulCorrections, apply_an_error_that_persists) {
  DoubtfulCorrections corrections({3, 1, 10});
  int refused = 0;
  while (refused < 100 && !applies(corrections, 0.1)) ++refused;
  EXPECT_EQ(refused, 11) << "the standard deviation of 12 steps is 0.035 m";
  EXPECT_FALSE(applies(corrections, 0.1)) << "the standard deviation begins again after a correction";
}

TEST(DoubtfulCorrections, begin_again_after_steps_that_are_not_judged) {
  DoubtfulCorrections corrections({3, 1, 10});
  for (int i = 0; i < 11; ++i) EXPECT_FALSE(applies(corrections, 0.1));
  corrections.add_unjudged();
  EXPECT_FALSE(applies(corrections, 0.1));
}

TEST(DoubtfulCorrections, limit_the_sum) {
  DoubtfulCorrections corrections({3, 0.2, 4.5});
  double sum_m = 0;
  for (int i = 0; i < 450; ++i)  // 45 m
    if (applies(corrections, 0.02)) sum_m += 0.02;
  EXPECT_GT(sum_m, 1.5);
  EXPECT_LT(sum_m, 2.3) << "at most 0.2 m in 4.5 m, after the first 0.2 m";
}

TEST(DoubtfulCorrections, apply_corrections_that_lower_the_sum) {
  DoubtfulCorrections corrections({3, 0.05, 1000});
  EXPECT_TRUE(applies(corrections, 0.025));
  EXPECT_TRUE(applies(corrections, 0.02));
  EXPECT_FALSE(applies(corrections, 0.02));
  EXPECT_TRUE(applies(corrections, -0.02));
}

TEST(DoubtfulCorrections, limit_the_sum_by_the_errors_of_the_last_step) {
  DoubtfulCorrections corrections({3, 0.05, 1000});
  corrections.moved(0.1, 0.1);
  EXPECT_TRUE(corrections.add_doubtful({0.2, 0})) << "errors of this step explain 0.3 m";
  corrections.moved(0.1, 0.01);
  EXPECT_TRUE(corrections.add_doubtful({-0.02, 0})) << "lowers the sum, which is above its limit";
  corrections.moved(0.1, 0.01);
  EXPECT_FALSE(corrections.add_doubtful({0.02, 0}));
}

TEST(DoubtfulCorrections, limit_the_sum_by_the_scale) {
  DoubtfulCorrections corrections({3, 0.05, 1000});
  support(corrections, 0.02);
  EXPECT_TRUE(applies(corrections, 0.05));
  EXPECT_TRUE(applies(corrections, 0.045)) << "the scale is 2";
  EXPECT_FALSE(applies(corrections, 0.05));
}

TEST(DoubtfulCorrections, learn_the_errors_of_poor_odometry_from_supported_corrections) {
  DoubtfulCorrections corrections({3, 1, 10});
  support(corrections, 0.02);
  corrections.moved(0.1, 0.01);
  EXPECT_NEAR(corrections.sigma_m(), 0.02, 1e-4);
  EXPECT_TRUE(corrections.add_doubtful(Vector2d(0, 0.05)));
}

TEST(DoubtfulCorrections, never_trust_odometry_more_than_its_standard_deviation) {
  DoubtfulCorrections corrections({3, 1, 10});
  support(corrections, 0.001);
  EXPECT_TRUE(applies(corrections, 0.029));
}

TEST(DoubtfulCorrections, learn_little_from_one_large_correction) {
  DoubtfulCorrections corrections({3, 1, 10});
  corrections.moved(0.1, 0.01);
  corrections.add_supported(10);
  EXPECT_FALSE(applies(corrections, 0.035));
}

TEST(DoubtfulCorrections, learn_nothing_from_a_motion_without_error) {
  DoubtfulCorrections corrections({3, 1, 10});
  corrections.moved(0, 0);
  corrections.add_supported(0.01);
  EXPECT_TRUE(applies(corrections, 0.029));
  EXPECT_FALSE(applies(corrections, 0.031));
}

TEST(DoubtfulCorrections, without_odometry_only_the_sum_is_limited) {
  DoubtfulCorrections corrections({3, 0.2, 1000});
  corrections.moved(0.1, {});
  EXPECT_TRUE(corrections.add_doubtful(Vector2d(0.15, 0)));
  corrections.moved(0.1, {});
  EXPECT_FALSE(corrections.add_doubtful(Vector2d(0.15, 0)));
  corrections.moved(0.1, {});
  corrections.add_supported(1);
  corrections.moved(0.1, 0.01);
  EXPECT_NEAR(corrections.sigma_m(), 0.01, 1e-9) << "nothing is learned about odometry";
}

}  // namespace
}  // namespace psi_slam
