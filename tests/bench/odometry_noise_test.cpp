// SPDX-License-Identifier: BSD-3-Clause
#include "robustness/odometry_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "base/random_draws.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

/// Odometry that turns and goes ahead by turns, 2.5 rad and 2.5 m, and where the robot was.
struct NoisyDrive {
  explicit NoisyDrive(const OdometryNoise& noise) {
    RandomDraws draws(3, "noise", 0);
    for (int i = 0; i < 60'000; ++i) {
      const bool turns = i / 50 % 2 == 0;
      const TPose2D motion = turns ? TPose2D(0, 0, 0.05) : TPose2D(0.05, 0, 0);
      const double sigma_m = turns ? 0 : noise.sigma_m_per_root_m * std::sqrt(0.05);
      const double sigma_rad =
          (turns ? noise.sigma_rad_per_root_rad : noise.sigma_rad_per_root_m) * std::sqrt(0.05);
      odometry.push_back(odometry.back() + motion);
      truth.push_back(truth.back() + TPose2D(motion.x + sigma_m * draws.normal(), sigma_m * draws.normal(),
                                             motion.phi + sigma_rad * draws.normal()));
    }
  }

  std::vector<TPose2D> odometry{{7, -2, 1}};
  std::vector<TPose2D> truth{{0, 0, 0}};
};

TEST(OdometryNoise, is_measured_as_it_was_made) {
  const NoisyDrive drive({0.04, 0.01, 0.03});
  const OdometryNoise noise = measure_odometry_noise(drive.odometry, drive.truth);
  EXPECT_NEAR(noise.sigma_m_per_root_m, 0.04, 0.001);
  EXPECT_NEAR(noise.sigma_rad_per_root_m, 0.01, 0.0005);
  EXPECT_NEAR(noise.sigma_rad_per_root_rad, 0.03, 0.001);
}

TEST(OdometryNoise, a_wrong_heading_is_no_error_of_the_way) {
  const NoisyDrive drive({0.001, 0.1, 0.1});
  const OdometryNoise noise = measure_odometry_noise(drive.odometry, drive.truth);
  EXPECT_NEAR(noise.sigma_m_per_root_m, 0.001, 0.0001);
  EXPECT_NEAR(noise.sigma_rad_per_root_m, 0.1, 0.005);
}

TEST(OdometryNoise, a_map_that_trembles_while_the_robot_stands_adds_none) {
  NoisyDrive drive({0.04, 0.01, 0.03});
  RandomDraws draws(4, "tremble", 0);
  const TPose2D stood_odometry = drive.odometry.back();
  const TPose2D stood_truth = drive.truth.back();
  for (int i = 0; i < 60'000; ++i) {
    drive.odometry.push_back(stood_odometry);
    drive.truth.push_back(stood_truth +
                          TPose2D(0.01 * draws.normal(), 0.01 * draws.normal(), 0.01 * draws.normal()));
  }
  const OdometryNoise noise = measure_odometry_noise(drive.odometry, drive.truth);
  EXPECT_NEAR(noise.sigma_m_per_root_m, 0.04, 0.001);
  EXPECT_NEAR(noise.sigma_rad_per_root_rad, 0.03, 0.001);
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
