// SPDX-License-Identifier: BSD-3-Clause
#include "matching/refinement.h"

#include <gtest/gtest.h>
#include <mrpt/math/wrap2pi.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <random>
#include <vector>

#include "score_grids.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

std::vector<double> scores_at(const ScoreGrid& grid, const ScanPoints& scan, const TPose2D& pose) {
  std::vector<double> scores;
  for (const auto& point : scan.points) {
    const auto x = static_cast<double>(point.x);
    const auto y = static_cast<double>(point.y);
    const double c = std::cos(pose.phi);
    const double s = std::sin(pose.phi);
    scores.push_back(grid.interpolate(pose.x + c * x - s * y, pose.y + s * x + c * y).value);
  }
  return scores;
}

double cost_at(const ScoreGrid& grid, const ScanPoints& scan, const TPose2D& pose, double score_sigma) {
  double cost = 0;
  for (const double score : scores_at(grid, scan, pose)) cost += (1 - score) * (1 - score);
  return cost / (score_sigma * score_sigma);
}

TPose2D moved(const TPose2D& pose, double dx, double dy, double dphi) {
  return {pose.x + dx, pose.y + dy, pose.phi + dphi};
}

// Returns J^T J / s^2. J is the Jacobian of the scores by central differences, and s is `score_sigma`.
Eigen::Matrix3d numeric_information(const ScoreGrid& grid, const ScanPoints& scan, const TPose2D& pose,
                                    double score_sigma) {
  constexpr double kStep = 1e-4;
  Eigen::Matrix<double, Eigen::Dynamic, 3> jacobian(scan.points.size(), 3);
  for (int k = 0; k < 3; ++k) {
    const double step[3] = {k == 0 ? kStep : 0, k == 1 ? kStep : 0, k == 2 ? kStep : 0};
    const auto ahead = scores_at(grid, scan, moved(pose, step[0], step[1], step[2]));
    const auto behind = scores_at(grid, scan, moved(pose, -step[0], -step[1], -step[2]));
    for (std::size_t i = 0; i < ahead.size(); ++i)
      jacobian(static_cast<Eigen::Index>(i), k) = (ahead[i] - behind[i]) / (2 * kStep);
  }
  return jacobian.transpose() * jacobian / (score_sigma * score_sigma);
}

// A corridor along x, 2 m wide. The scores along its walls vary randomly.
struct Corridor {
  ScoreGrid grid{-12, -2, 0.05, 480, 80};
  ScanPoints scan;  // scan of a robot in the middle, at the origin

  explicit Corridor(std::mt19937_64& random) {
    std::uniform_int_distribution<int> seen(200, 255);
    for (const double wall_y : {-1.0, 1.0}) {
      const int row = static_cast<int>(std::floor((wall_y + 2) / 0.05));
      for (int x = 10; x < 470; ++x) {
        const int score = seen(random);
        *grid.finest().cell(x, row) = static_cast<std::uint8_t>(score);
        *grid.finest().cell(x, row + 1) = static_cast<std::uint8_t>(score * 3 / 5);
        *grid.finest().cell(x, row - 1) = static_cast<std::uint8_t>(score * 3 / 5);
      }
      for (int i = -60; i <= 60; ++i) {
        const double x = 0.1 * i;
        scan.points.emplace_back(static_cast<float>(x), static_cast<float>(wall_y + 0.025));
        scan.normals.emplace_back(0.0F, wall_y > 0 ? -1.0F : 1.0F);
        scan.farthest_m = std::max(scan.farthest_m, std::hypot(x, wall_y));
      }
    }
  }
};

TEST(Refinement, finds_fifty_random_poses_from_half_a_cell_away) {
  const SimulatedWalls room = furnished_room();
  const ScoreGrid grid = grid_of(room);
  std::mt19937_64 random(51);
  std::uniform_real_distribution<double> x(2.0, 6.0);
  std::uniform_real_distribution<double> y(1.5, 4.0);
  std::uniform_real_distribution<double> heading(-M_PI, M_PI);
  std::uniform_real_distribution<double> off_m(-0.025, 0.025);
  std::uniform_real_distribution<double> off_rad(-0.003, 0.003);
  for (int trial = 0; trial < 50; ++trial) {
    const TPose2D truth(x(random), y(random), heading(random));
    const ScanPoints scan = scan_of(room, truth, 360, 0.01, random);
    const TPose2D start(truth.x + off_m(random), truth.y + off_m(random), truth.phi + off_rad(random));
    const RefinedPose refined = refine(grid, scan, start, {});
    EXPECT_NEAR(refined.map_T_robot.x, truth.x, 0.003) << "trial " << trial;
    EXPECT_NEAR(refined.map_T_robot.y, truth.y, 0.003) << "trial " << trial;
    EXPECT_NEAR(mrpt::math::wrapToPi(refined.map_T_robot.phi - truth.phi), 0, 0.001) << "trial " << trial;
    EXPECT_GT(refined.mean_score, 0.9);
    EXPECT_LE(refined.iterations, RefinementOptions{}.max_iterations);
  }
}

TEST(Refinement, never_makes_the_cost_larger) {
  const SimulatedWalls room = furnished_room();
  const ScoreGrid grid = grid_of(room);
  std::mt19937_64 random(52);
  std::uniform_real_distribution<double> off_m(-0.3, 0.3);
  for (int trial = 0; trial < 100; ++trial) {
    const TPose2D truth(3.1, 2.7, 0.05 * trial);
    const ScanPoints scan = scan_of(room, truth, 90, 0.02, random);
    const TPose2D start(truth.x + off_m(random), truth.y + off_m(random), truth.phi + off_m(random));
    const RefinedPose refined = refine(grid, scan, start, {});
    EXPECT_LE(cost_at(grid, scan, refined.map_T_robot, 0.5), cost_at(grid, scan, start, 0.5) + 1e-9);
  }
}

TEST(Refinement, mean_score_is_that_of_the_points_at_the_pose) {
  const SimulatedWalls room = furnished_room();
  const ScoreGrid grid = grid_of(room);
  std::mt19937_64 random(53);
  const ScanPoints scan = scan_of(room, {4, 3, 1}, 100, 0.02, random);
  const RefinedPose refined = refine(grid, scan, {4.01, 3.01, 1.01}, {});
  double sum = 0;
  for (const double score : scores_at(grid, scan, refined.map_T_robot)) sum += score;
  EXPECT_NEAR(refined.mean_score, sum / 100, 1e-9);
}

TEST(Refinement, information_equals_that_of_numeric_derivatives) {
  const SimulatedWalls room = furnished_room();
  const ScoreGrid grid = grid_of(room);
  std::mt19937_64 random(54);
  std::uniform_real_distribution<double> heading(-M_PI, M_PI);
  for (int trial = 0; trial < 20; ++trial) {
    const TPose2D truth(3.1, 2.7, heading(random));
    const ScanPoints scan = scan_of(room, truth, 180, 0.02, random);
    RefinementOptions options;
    options.score_sigma = 0.3 + 0.05 * trial;
    const RefinedPose refined = refine(grid, scan, truth, options);
    const Eigen::Matrix3d expected =
        numeric_information(grid, scan, refined.map_T_robot, options.score_sigma);
    EXPECT_LT((refined.information - expected).norm(), 1e-3 * expected.norm())
        << refined.information << "\nnot\n"
        << expected;
    EXPECT_EQ(refined.information, Eigen::Matrix3d(refined.information.transpose()));
  }
}

// If the scores are linear in the position, the Gauss-Newton approximation is exact: the information is half
// the second derivative of the cost.
TEST(Refinement, information_is_half_the_numeric_second_derivative_of_the_cost_on_a_ramp) {
  ScoreGrid grid(-1, -1, 0.05, 60, 60);
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 60; ++x) *grid.finest().cell(x, y) = static_cast<std::uint8_t>(3 * x + y);
  std::mt19937_64 random(55);
  const ScanPoints scan = random_points(random, 40, 0.5);
  RefinementOptions options;
  options.max_iterations = 0;
  const TPose2D pose(0.5, 0.4, 0.3);
  const RefinedPose refined = refine(grid, scan, pose, options);

  // The step is large, because the cost is a parabola and the grid computes in single precision.
  constexpr double kStep = 0.02;
  const auto cost = [&](double dx, double dy) {
    return cost_at(grid, scan, moved(pose, dx, dy, 0), options.score_sigma);
  };
  const double xx = (cost(kStep, 0) - 2 * cost(0, 0) + cost(-kStep, 0)) / (kStep * kStep);
  const double yy = (cost(0, kStep) - 2 * cost(0, 0) + cost(0, -kStep)) / (kStep * kStep);
  const double xy = (cost(kStep, kStep) - cost(kStep, -kStep) - cost(-kStep, kStep) + cost(-kStep, -kStep)) /
                    (4 * kStep * kStep);
  EXPECT_NEAR(2 * refined.information(0, 0), xx, 1e-2 * xx);
  EXPECT_NEAR(2 * refined.information(1, 1), yy, 1e-2 * xx);
  EXPECT_NEAR(2 * refined.information(0, 1), xy, 1e-2 * xx);
}

TEST(Refinement, with_normals_a_corridor_gives_no_information_along_it) {
  std::mt19937_64 random(56);
  Corridor corridor(random);
  const RefinedPose with = refine(corridor.grid, corridor.scan, {0, 0.01, 0.002}, {});
  EXPECT_LT(with.information(0, 0), 1e-3 * with.information(1, 1));
  EXPECT_GT(with.information(2, 2), with.information(1, 1)) << "the walls determine the heading";

  corridor.scan.normals.clear();
  const RefinedPose without = refine(corridor.grid, corridor.scan, {0, 0.01, 0.002}, {});
  EXPECT_GT(without.information(0, 0), 10 * with.information(0, 0))
      << "without normals, noise of the walls counts as information";
}

// Along the corridor, the scores contain only noise. Noise must neither move the pose nor stop the
// minimisation.
TEST(Refinement, without_a_prior_a_corridor_is_refined_across_it) {
  std::mt19937_64 random(65);
  for (int trial = 0; trial < 20; ++trial) {
    const Corridor corridor(random);
    const RefinedPose refined = refine(corridor.grid, corridor.scan, {0.01 * trial, 0.012, 0.003}, {});
    EXPECT_NEAR(refined.map_T_robot.x, 0.01 * trial, 0.01) << "x moves by at most a fifth of a cell";
    EXPECT_NEAR(refined.map_T_robot.y, 0, 0.005);
    EXPECT_NEAR(refined.map_T_robot.phi, 0, 0.002);
  }
}

TEST(Refinement, normals_turn_with_the_robot) {
  std::mt19937_64 random(57);
  Corridor corridor(random);
  // Makes the scan of a robot turned by 0.7 rad: turns points and normals back into the robot's frame.
  const double c = std::cos(-0.7);
  const double s = std::sin(-0.7);
  for (auto* vectors : {&corridor.scan.points, &corridor.scan.normals})
    for (auto& v : *vectors) {
      const auto x = static_cast<double>(v.x);
      const auto y = static_cast<double>(v.y);
      v = {static_cast<float>(c * x - s * y), static_cast<float>(s * x + c * y)};
    }
  const RefinedPose refined = refine(corridor.grid, corridor.scan, {0, 0.01, 0.702}, {});
  EXPECT_LT(refined.information(0, 0), 1e-3 * refined.information(1, 1));
  EXPECT_NEAR(refined.map_T_robot.y, 0, 0.004);
  EXPECT_NEAR(refined.map_T_robot.phi, 0.7, 0.002);
}

TEST(Refinement, points_without_a_normal_keep_their_whole_slope) {
  std::mt19937_64 random(58);
  Corridor corridor(random);
  const TPose2D pose(0, 0.01, 0.002);
  RefinementOptions options;
  options.max_iterations = 0;
  for (auto& normal : corridor.scan.normals) normal = {0, 0};
  const RefinedPose zeros = refine(corridor.grid, corridor.scan, pose, options);
  corridor.scan.normals.clear();
  const RefinedPose none = refine(corridor.grid, corridor.scan, pose, options);
  EXPECT_EQ(zeros.information, none.information);
}

TEST(Refinement, the_prior_holds_the_pose_along_a_corridor) {
  std::mt19937_64 random(59);
  const Corridor corridor(random);
  PosePrior prior;
  prior.map_T_robot = {0.07, 0.04, 0.003};
  prior.information.diagonal() << 1 / (0.03 * 0.03), 1 / (0.03 * 0.03), 1 / (0.1 * 0.1);
  const RefinedPose refined = refine(corridor.grid, corridor.scan, {0, 0.02, 0}, {}, prior);
  EXPECT_NEAR(refined.map_T_robot.x, 0.07, 0.002) << "the prior determines x";
  EXPECT_NEAR(refined.map_T_robot.y, 0, 0.004) << "the scan determines y";
  EXPECT_LT(refined.information(0, 0), 1e-3 * refined.information(1, 1))
      << "the information of the scan excludes the prior";
}

TEST(Refinement, a_certain_prior_decides_across_the_turn_of_the_heading) {
  const SimulatedWalls room = furnished_room();
  const ScoreGrid grid = grid_of(room);
  std::mt19937_64 random(60);
  const ScanPoints scan = scan_of(room, {4, 3, M_PI - 0.002}, 100, 0.01, random);
  PosePrior prior;
  prior.map_T_robot = {4.01, 3.01, -M_PI + 0.002};
  prior.information = Eigen::Matrix3d::Identity() * 1e10;
  const RefinedPose refined = refine(grid, scan, {4, 3, M_PI - 0.002}, {}, prior);
  EXPECT_NEAR(refined.map_T_robot.x, 4.01, 1e-4);
  EXPECT_NEAR(refined.map_T_robot.y, 3.01, 1e-4);
  EXPECT_NEAR(mrpt::math::wrapToPi(refined.map_T_robot.phi - prior.map_T_robot.phi), 0, 1e-4);
  EXPECT_LE(std::abs(refined.map_T_robot.phi), M_PI);
}

TEST(Refinement, farther_than_the_largest_shift_is_another_peak) {
  const SimulatedWalls room = furnished_room();
  const ScoreGrid grid = grid_of(room);
  std::mt19937_64 random(61);
  const ScanPoints scan = scan_of(room, {4, 3, 1}, 100, 0.01, random);
  const TPose2D start(4.03, 3.0, 1);
  RefinementOptions options;
  options.max_shift_m = 0.02;
  const RefinedPose refused = refine(grid, scan, start, options);
  EXPECT_EQ(refused.map_T_robot, start);
  options.max_iterations = 0;
  const RefinedPose unmoved = refine(grid, scan, start, options);
  EXPECT_EQ(refused.mean_score, unmoved.mean_score);
  EXPECT_EQ(refused.information, unmoved.information);
  options = {};
  EXPECT_LT(refine(grid, scan, start, options).map_T_robot.x, 4.01)
      << "without the limit, the pose would move to the other peak";
}

TEST(Refinement, without_points_or_off_the_grid_the_start_is_returned) {
  const ScoreGrid grid = grid_of(furnished_room());
  const RefinedPose no_points = refine(grid, {}, {1, 2, 0.5}, {});
  EXPECT_EQ(no_points.map_T_robot, TPose2D(1, 2, 0.5));
  EXPECT_EQ(no_points.mean_score, 0);
  std::mt19937_64 random(62);
  const RefinedPose off = refine(grid, random_points(random, 20, 1), {500, 0, 0.5}, {});
  EXPECT_EQ(off.map_T_robot, TPose2D(500, 0, 0.5));
  EXPECT_EQ(off.information, Eigen::Matrix3d(Eigen::Matrix3d::Zero()));
}

Eigen::Matrix3d random_information(std::mt19937_64& random, double smallest, double largest) {
  std::normal_distribution<double> normal(0, 1);
  Eigen::Matrix3d any;
  for (int i = 0; i < 9; ++i) any(i / 3, i % 3) = normal(random);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(any + any.transpose());
  std::uniform_real_distribution<double> exponent(std::log(smallest), std::log(largest));
  const Eigen::Vector3d values(std::exp(exponent(random)), std::exp(exponent(random)),
                               std::exp(exponent(random)));
  return axes.eigenvectors() * values.asDiagonal() * axes.eigenvectors().transpose();
}

TEST(BoundedCovariance, within_the_bounds_is_the_inverse) {
  std::mt19937_64 random(63);
  for (int trial = 0; trial < 100; ++trial) {
    const double lever_m = 1 + trial % 7;
    // Standard deviations of 6 mm to 0.7 m.
    Eigen::Matrix3d information = random_information(random, 2.0, 3e4);
    const Eigen::Vector3d to_radians(1, 1, lever_m);
    information = to_radians.asDiagonal() * information * to_radians.asDiagonal();
    const Eigen::Matrix3d covariance = bounded_covariance(information, 0.005, 2.0, lever_m);
    EXPECT_LT((covariance * information - Eigen::Matrix3d::Identity()).norm(), 1e-6);
    EXPECT_LT((covariance - covariance.transpose()).norm(), 1e-12);
  }
}

TEST(BoundedCovariance, of_no_information_has_the_largest_deviations) {
  const Eigen::Matrix3d covariance = bounded_covariance(Eigen::Matrix3d::Zero(), 0.005, 2.0, 10.0);
  EXPECT_TRUE(covariance.isApprox(Eigen::Vector3d(4, 4, 0.04).asDiagonal().toDenseMatrix(), 1e-9))
      << covariance;
}

TEST(BoundedCovariance, of_endless_information_has_the_smallest_deviations) {
  const Eigen::Matrix3d covariance = bounded_covariance(Eigen::Matrix3d::Identity() * 1e12, 0.005, 2.0, 10.0);
  EXPECT_TRUE(covariance.isApprox(Eigen::Vector3d(25e-6, 25e-6, 25e-8).asDiagonal().toDenseMatrix(), 1e-9))
      << covariance;
}

TEST(BoundedCovariance, a_direction_without_information_stays_apart_from_the_others) {
  // The information is zero along the diagonal of x and y.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  const Eigen::Vector3d across = Eigen::Vector3d(1, -1, 0).normalized();
  information += 400 * across * across.transpose();
  information(2, 2) = 2500;
  const Eigen::Matrix3d covariance = bounded_covariance(information, 0.005, 2.0, 1.0);
  const Eigen::Vector3d along = Eigen::Vector3d(1, 1, 0).normalized();
  EXPECT_NEAR(along.dot(covariance * along), 4, 1e-9);
  EXPECT_NEAR(across.dot(covariance * across), 1.0 / 400, 1e-9);
  EXPECT_NEAR(covariance(2, 2), 1.0 / 2500, 1e-9);
}

TEST(BoundedCovariance, deviations_are_bounded_whatever_the_information) {
  std::mt19937_64 random(64);
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::Matrix3d covariance =
        bounded_covariance(random_information(random, 1e-9, 1e12), 0.01, 1.5, 1.0);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(covariance);
    EXPECT_GE(axes.eigenvalues()[0], 0.01 * 0.01 * (1 - 1e-6));
    EXPECT_LE(axes.eigenvalues()[2], 1.5 * 1.5 * (1 + 1e-6));
  }
}

}  // namespace
}  // namespace psi_slam
