// SPDX-License-Identifier: BSD-3-Clause
#include "matching/refinement_kernel.h"

#include <gtest/gtest.h>
#include <mrpt/math/TPose2D.h>

#include <array>
#include <cmath>
#include <random>

#include "matching/scan_points.h"
#include "matching/score_grid.h"

namespace psi_slam {
namespace {

std::array<double, 11> in_a_row(const ScoreSums& sums) {
  return {sums.squares, sums.scores,  sums.xx, sums.xy, sums.yy, sums.x_phi,
          sums.y_phi,   sums.phi_phi, sums.x,  sums.y,  sums.phi};
}

ScoreGrid grid_of_random_scores(std::mt19937_64& random) {
  ScoreGrid grid(-1.5, -1.0, 0.05, 60, 41);
  for (int y = 0; y < 41; ++y)
    for (int x = 0; x < 60; ++x) *grid.finest().cell(x, y) = static_cast<std::uint8_t>(random() % 256);
  return grid;
}

// Some points lie outside the grid, and some normals are unknown.
ScanPoints random_scan(std::mt19937_64& random, std::size_t count, bool with_normals) {
  std::uniform_real_distribution<float> coordinate(-2.0F, 2.0F), angle(-3.0F, 3.0F);
  ScanPoints scan;
  for (std::size_t i = 0; i < count; ++i) {
    scan.points.emplace_back(coordinate(random), coordinate(random));
    if (!with_normals) continue;
    const float normal = angle(random);
    const bool known = random() % 4 != 0;
    scan.normals.emplace_back(known ? std::cos(normal) : 0.0F, known ? std::sin(normal) : 0.0F);
  }
  return scan;
}

struct Problem {
  ScoreGrid grid;
  ScanPoints scan;
  double x_m, y_m, phi;

  Problem(std::mt19937_64& random, std::size_t count, bool with_normals)
      : grid(grid_of_random_scores(random)), scan(random_scan(random, count, with_normals)) {
    std::uniform_real_distribution<double> coordinate(-0.5, 0.5), angle(-3, 3);
    x_m = coordinate(random);
    y_m = coordinate(random);
    phi = angle(random);
  }

  ScoreSums by_kernel(InstructionSet set) const {
    return refinement_kernel_for(set)(placed(grid, scan, {x_m, y_m, phi}));
  }

  ScoreSums point_by_point() const {
    ScoreSums sums;
    for (std::size_t i = 0; i < scan.points.size(); ++i) {
      const auto turned = [&](const mrpt::math::TPoint2Df& p) {
        const auto x = static_cast<double>(p.x), y = static_cast<double>(p.y);
        return mrpt::math::TPoint2D(std::cos(phi) * x - std::sin(phi) * y,
                                    std::sin(phi) * x + std::cos(phi) * y);
      };
      const mrpt::math::TPoint2D arm = turned(scan.points[i]);
      ScoreGrid::Sample sample = grid.interpolate(x_m + arm.x, y_m + arm.y);
      if (!scan.normals.empty() && (scan.normals[i].x != 0.0F || scan.normals[i].y != 0.0F)) {
        const mrpt::math::TPoint2D normal = turned(scan.normals[i]);
        const double slope = sample.d_dx * normal.x + sample.d_dy * normal.y;
        sample.d_dx = slope * normal.x;
        sample.d_dy = slope * normal.y;
      }
      const double d_dphi = arm.x * sample.d_dy - arm.y * sample.d_dx;
      const double residual = 1 - sample.value;
      sums.squares += residual * residual;
      sums.scores += sample.value;
      sums.xx += sample.d_dx * sample.d_dx;
      sums.xy += sample.d_dx * sample.d_dy;
      sums.yy += sample.d_dy * sample.d_dy;
      sums.x_phi += sample.d_dx * d_dphi;
      sums.y_phi += sample.d_dy * d_dphi;
      sums.phi_phi += d_dphi * d_dphi;
      sums.x += sample.d_dx * residual;
      sums.y += sample.d_dy * residual;
      sums.phi += d_dphi * residual;
    }
    return sums;
  }
};

TEST(RefinementKernel, equals_the_sums_point_by_point) {
  std::mt19937_64 random(5);
  for (std::size_t count = 0; count < 200; ++count) {
    const Problem problem(random, count, count % 3 != 0);
    const auto expected = in_a_row(problem.point_by_point());
    const auto found = in_a_row(problem.by_kernel(InstructionSet::kBaseline));
    for (std::size_t k = 0; k < expected.size(); ++k)
      ASSERT_NEAR(found[k], expected[k], 1e-4 * (1 + std::abs(expected[k]))) << count << " points, sum " << k;
  }
}

TEST(RefinementKernel, gives_the_same_bytes_with_every_set) {
  std::mt19937_64 random(6);
  for (std::size_t count = 0; count < 200; ++count) {
    const Problem problem(random, count, count % 2 == 0);
    const auto expected = in_a_row(problem.by_kernel(InstructionSet::kBaseline));
    for (const InstructionSet set : kInstructionSets) {
      if (refinement_kernel_for(set) == nullptr) continue;
      ASSERT_EQ(in_a_row(problem.by_kernel(set)), expected)
          << "set " << static_cast<int>(set) << ", " << count;
    }
  }
}

TEST(RefinementKernel, gives_points_far_away_the_score_0) {
  std::mt19937_64 random(7);
  Problem problem(random, 13, false);
  const ScoreSums before = problem.by_kernel(InstructionSet::kBaseline);
  problem.scan.points.emplace_back(-1e6F, 0.0F);
  problem.scan.points.emplace_back(1e30F, -1e30F);
  for (const InstructionSet set : kInstructionSets) {
    if (refinement_kernel_for(set) == nullptr) continue;
    const ScoreSums after = problem.by_kernel(set);
    std::array<double, 11> sums = in_a_row(after), expected = in_a_row(before);
    sums[0] = expected[0] = 0;  // the squares
    EXPECT_EQ(sums, expected);
    EXPECT_NEAR(after.squares, before.squares + 2, 1e-9);
  }
}

}  // namespace
}  // namespace psi_slam
