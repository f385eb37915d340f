// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/simulated_log.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

struct Moments {
  double mean = 0;
  double variance = 0;
};

constexpr int kRuns = 4000;
constexpr double kMeanBound = 5;         // largest accepted error of a mean, in its standard deviations
constexpr double kVarianceShare = 0.12;  // largest accepted relative error of a variance: over five sigma

Moments moments(const std::vector<double>& values) {
  Moments result;
  for (const double value : values) result.mean += value / static_cast<double>(values.size());
  for (const double value : values)
    result.variance += std::pow(value - result.mean, 2) / static_cast<double>(values.size() - 1);
  return result;
}

/// Odometry after `steps` equal steps, for kRuns runs with different seeds.
std::vector<TPose2D> ends(WheelOdometryOptions options, const TPose2D& step, int steps) {
  std::vector<TPose2D> poses;
  for (int run = 0; run < kRuns; ++run) {
    options.seed = static_cast<std::uint64_t>(run);
    WheelOdometry odometry(options);
    TPose2D pose;
    for (int i = 0; i < steps; ++i) pose = odometry.move(step);
    poses.push_back(pose);
  }
  return poses;
}

void expect_moments(const std::vector<double>& values, double mean, double sigma) {
  const Moments found = moments(values);
  EXPECT_NEAR(found.mean, mean, kMeanBound * sigma / std::sqrt(kRuns));
  EXPECT_NEAR(found.variance, sigma * sigma, kVarianceShare * sigma * sigma);
}

// The error over 4 m must not depend on the length of the steps.
TEST(WheelOdometry, distances_have_a_scale_error_and_a_random_walk) {
  for (const int steps : {4, 80}) {
    WheelOdometryOptions options;
    options.sigma_rad_per_root_m = 0;
    std::vector<double> lengths;
    for (const TPose2D& end : ends(options, {4.0 / steps, 0, 0}, steps)) lengths.push_back(end.x);
    expect_moments(lengths, 4 * options.length_scale, 2 * options.sigma_m_per_root_m);
  }
}

TEST(WheelOdometry, headings_drift_with_distance) {
  for (const int steps : {4, 80}) {
    const WheelOdometryOptions options;
    std::vector<double> headings;
    for (const TPose2D& end : ends(options, {4.0 / steps, 0, 0}, steps)) headings.push_back(end.phi);
    expect_moments(headings, 0, 2 * options.sigma_rad_per_root_m);
  }
}

TEST(WheelOdometry, rotations_have_a_scale_error_and_a_random_walk) {
  for (const int steps : {2, 40}) {
    const WheelOdometryOptions options;
    std::vector<double> headings;
    for (const TPose2D& end : ends(options, {0, 0, -2.0 / steps}, steps)) {
      headings.push_back(end.phi);
      EXPECT_EQ(std::hypot(end.x, end.y), 0);
    }
    expect_moments(headings, -2 * options.turn_scale, std::sqrt(2) * options.sigma_rad_per_root_rad);
  }
}

TEST(WheelOdometry, depends_on_the_seed_alone) {
  WheelOdometryOptions options;
  const TPose2D first = WheelOdometry(options).move({1, 0, 0.1});
  EXPECT_EQ(first, WheelOdometry(options).move({1, 0, 0.1}));
  options.seed = 2;
  EXPECT_NE(first.x, WheelOdometry(options).move({1, 0, 0.1}).x);
}

}  // namespace
}  // namespace psi_slam
