// SPDX-License-Identifier: BSD-3-Clause
#include "robustness/robustness_benchmark.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "base/random_draws.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

/// Odometry that alternates between rotations by 2.5 rad and 2.5 m straight ahead, and the true poses.
struct NoisyRun {
  explicit NoisyRun(const OdometryNoise& noise) {
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

TEST(OdometryNoise, is_measured_as_simulated) {
  const NoisyRun run({0.04, 0.01, 0.03});
  const OdometryNoise noise = measure_odometry_noise(run.odometry, run.truth);
  EXPECT_NEAR(noise.sigma_m_per_root_m, 0.04, 0.001);
  EXPECT_NEAR(noise.sigma_rad_per_root_m, 0.01, 0.0005);
  EXPECT_NEAR(noise.sigma_rad_per_root_rad, 0.03, 0.001);
}

TEST(OdometryNoise, a_wrong_heading_adds_no_error_of_position) {
  const NoisyRun run({0.001, 0.1, 0.1});
  const OdometryNoise noise = measure_odometry_noise(run.odometry, run.truth);
  EXPECT_NEAR(noise.sigma_m_per_root_m, 0.001, 0.0001);
  EXPECT_NEAR(noise.sigma_rad_per_root_m, 0.1, 0.005);
}

TEST(OdometryNoise, jitter_of_the_map_at_a_standing_robot_adds_none) {
  NoisyRun run({0.04, 0.01, 0.03});
  RandomDraws draws(4, "tremble", 0);
  const TPose2D stood_odometry = run.odometry.back();
  const TPose2D stood_truth = run.truth.back();
  for (int i = 0; i < 60'000; ++i) {
    run.odometry.push_back(stood_odometry);
    run.truth.push_back(stood_truth +
                        TPose2D(0.01 * draws.normal(), 0.01 * draws.normal(), 0.01 * draws.normal()));
  }
  const OdometryNoise noise = measure_odometry_noise(run.odometry, run.truth);
  EXPECT_NEAR(noise.sigma_m_per_root_m, 0.04, 0.001);
  EXPECT_NEAR(noise.sigma_rad_per_root_rad, 0.03, 0.001);
}

TEST(OdometryNoise, is_zero_for_perfect_odometry_and_a_standing_robot) {
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
