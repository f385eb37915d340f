// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/logs/odometry_noise.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "psi_slam/base/random_draws.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

TEST(OdometryNoise, is_measured_as_it_was_made) {
  RandomDraws draws(3, "noise", 0);
  std::vector<TPose2D> truth{{0, 0, 0}};
  std::vector<TPose2D> odometry{{7, -2, 1}};
  for (int i = 0; i < 60'000; ++i) {
    const bool turns = i / 50 % 2 == 0;
    const TPose2D motion = turns ? TPose2D(0, 0, 0.05) : TPose2D(0.05, 0, 0);
    const double sigma_m = turns ? 0 : 0.04 * std::sqrt(0.05);
    const double sigma_rad = (turns ? 0.03 : 0.01) * std::sqrt(0.05);
    truth.push_back(truth.back() + motion);
    odometry.push_back(odometry.back() + TPose2D(motion.x + sigma_m * draws.normal(),
                                                 sigma_m * draws.normal(),
                                                 motion.phi + sigma_rad * draws.normal()));
  }
  const OdometryNoise noise = measure_odometry_noise(odometry, truth);
  EXPECT_NEAR(noise.sigma_m_per_root_m, 0.04, 0.003);
  EXPECT_NEAR(noise.sigma_rad_per_root_m, 0.01, 0.001);
  EXPECT_NEAR(noise.sigma_rad_per_root_rad, 0.03, 0.002);
}

TEST(OdometryNoise, perfect_odometry_and_robots_that_stand_have_none) {
  std::vector<TPose2D> poses;
  for (int i = 0; i < 100; ++i) poses.emplace_back(0.1 * i, 0, 0);
  for (const auto& standing : {poses, std::vector<TPose2D>(10), std::vector<TPose2D>()}) {
    const OdometryNoise noise = measure_odometry_noise(standing, standing);
    EXPECT_NEAR(noise.sigma_m_per_root_m, 0, 1e-9);
    EXPECT_NEAR(noise.sigma_rad_per_root_m, 0, 1e-9);
    EXPECT_NEAR(noise.sigma_rad_per_root_rad, 0, 1e-9);
  }
  EXPECT_THROW(measure_odometry_noise(poses, {}), std::invalid_argument);
}

}  // namespace
}  // namespace psi_slam
