// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/scan_simulator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "plan_geometry.h"
#include "simulation/robot_path.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

ScanSimulatorOptions exact() {
  ScanSimulatorOptions options;
  options.noise_m = 0;
  options.dropout_share = 0;
  return options;
}

/// A wall of glass 3 m ahead of the origin, and a solid wall 5 m ahead.
FloorPlan glass_before_wall() {
  FloorPlan plan;
  plan.segments = {{{3, -20}, {3, 20}, Material::kGlass}, {{5, -20}, {5, 20}, Material::kWall}};
  return plan;
}

/// True if a range without noise is within two cells of the true range, or ends within two cells of a
/// surface.
bool within_a_cell(const FloorPlan& plan, const TPose2D& ray, double range_m, double cell_m) {
  if (std::abs(range_m - ray_m(plan, ray, true)) <= 2 * cell_m) return true;
  const mrpt::math::TPoint2D end(ray.x + range_m * std::cos(ray.phi), ray.y + range_m * std::sin(ray.phi));
  return clearance_m(plan, end) <= 2 * cell_m;
}

TEST(ScanSimulator, agrees_with_rays_and_segments) {
  FloorPlanOptions plan_options;
  plan_options.glass_share = 0;
  const FloorPlan plan = draw_floor_plan(plan_options);
  const ScanSimulatorOptions options = exact();
  ScanSimulator simulator(plan, options);
  RobotPathOptions path_options;
  path_options.path_m = 100;
  RobotPath path(plan, path_options);
  std::size_t beams = 0;
  std::size_t within_two_cells = 0;
  for (int i = 0; const std::optional<PathPose> pose = path.next(); ++i) {
    if (i % 50 != 0) continue;
    const LaserScan scan = simulator.scan(pose->world_T_robot, {}, 0);
    const TPose2D laser = pose->world_T_robot + options.robot_T_laser;
    for (std::size_t beam = 0; beam < options.beams; ++beam) {
      const TPose2D ray(laser.x, laser.y, laser.phi + static_cast<double>((*scan.bearings_rad)[beam]));
      const auto range = static_cast<double>(scan.ranges_m[beam]);
      const double true_m = ray_m(plan, ray, true);
      ++beams;
      if (!std::isfinite(range)) {
        EXPECT_GT(true_m, options.max_range_m - 2 * options.resolution_m);
        continue;
      }
      within_two_cells += std::abs(range - true_m) <= 2 * options.resolution_m;
      EXPECT_TRUE(within_a_cell(plan, ray, range, options.resolution_m)) << range << " for " << true_m;
    }
  }
  ASSERT_GT(beams, 3000U);
  EXPECT_GT(static_cast<double>(within_two_cells), 0.9 * static_cast<double>(beams))
      << "all but grazing ones";
}

TEST(ScanSimulator, no_beam_slips_through_a_slanting_wall) {
  FloorPlan plan;
  const std::vector<mrpt::math::TPoint2D> corners = {{4, -3}, {5, 2.5}, {0.3, 4}, {-4, 3.1}, {-3, -4.2}};
  for (std::size_t i = 0; i < corners.size(); ++i)
    plan.segments.push_back({corners[i], corners[(i + 1) % corners.size()], Material::kWall});
  ScanSimulatorOptions options = exact();
  options.beams = 2001;
  ScanSimulator simulator(plan, options);
  for (int i = 0; i < 20; ++i) {
    const TPose2D robot(0.11 * i - 1, 0.07 * i - 0.7, 0.3 * i);
    const LaserScan scan = simulator.scan(robot, {}, 0);
    const TPose2D laser = robot + options.robot_T_laser;
    for (std::size_t beam = 0; beam < options.beams; ++beam) {
      const TPose2D ray(laser.x, laser.y, laser.phi + static_cast<double>((*scan.bearings_rad)[beam]));
      ASSERT_NEAR(static_cast<double>(scan.ranges_m[beam]), ray_m(plan, ray, true), 0.1) << "beam " << beam;
    }
  }
}

TEST(ScanSimulator, glass_returns_some_beams_loses_some_and_lets_the_others_pass) {
  const FloorPlan plan = glass_before_wall();
  ScanSimulatorOptions options = exact();
  options.field_of_view_rad = 0.5;
  options.robot_T_laser = {0, 0, 0};
  ScanSimulator simulator(plan, options);
  double at_glass = 0;
  double lost = 0;
  double all = 0;
  for (std::uint64_t index = 0; index < 50; ++index) {
    const LaserScan scan = simulator.scan({0, 0, 0}, {}, index);
    for (std::size_t beam = 0; beam < options.beams; ++beam) {
      const double range = static_cast<double>(scan.ranges_m[beam]);
      const double x = range * std::cos(static_cast<double>((*scan.bearings_rad)[beam]));
      ++all;
      lost += std::isinf(range) ? 1 : 0;
      at_glass += std::abs(x - 3) < 0.05 ? 1 : 0;
      EXPECT_TRUE(std::isinf(range) || std::abs(x - 3) < 0.05 || std::abs(x - 5) < 0.05) << x;
    }
  }
  const double bound = 5 * std::sqrt(0.25 / all);
  EXPECT_NEAR(at_glass / all, options.glass_return_share, bound);
  EXPECT_NEAR(lost / all, options.glass_loss_share, bound);
}

TEST(ScanSimulator, people_block_beams) {
  FloorPlan plan;
  plan.segments = {{{5, -20}, {5, 20}, Material::kWall}};
  ScanSimulatorOptions options = exact();
  options.robot_T_laser = {0, 0, 0};
  ScanSimulator simulator(plan, options);
  const std::size_t ahead = options.beams / 2;
  EXPECT_NEAR(static_cast<double>(simulator.scan({0, 0, 0}, {}, 0).ranges_m[ahead]), 5, 0.03);
  EXPECT_NEAR(static_cast<double>(simulator.scan({0, 0, 0}, {{2, 0}}, 0).ranges_m[ahead]), 1.8, 0.001);
  EXPECT_NEAR(static_cast<double>(simulator.scan({0, 0, 0}, {{-2, 0}}, 0).ranges_m[ahead]), 5, 0.03);
}

TEST(ScanSimulator, has_the_requested_noise_and_dropouts) {
  FloorPlan plan;
  plan.segments = {{{5, -20}, {5, 20}, Material::kWall}};
  ScanSimulatorOptions options;
  options.field_of_view_rad = 0.5;
  options.dropout_share = 0.1;
  ScanSimulatorOptions plain = exact();
  plain.field_of_view_rad = 0.5;
  const LaserScan truth = ScanSimulator(plan, plain).scan({0, 0, 0}, {}, 0);
  ScanSimulator simulator(plan, options);
  double lost = 0;
  double sum2 = 0;
  double all = 0;
  for (std::uint64_t index = 0; index < 50; ++index) {
    const LaserScan scan = simulator.scan({0, 0, 0}, {}, index);
    for (std::size_t beam = 0; beam < options.beams; ++beam) {
      ++all;
      if (std::isinf(scan.ranges_m[beam])) {
        ++lost;
      } else {
        sum2 += std::pow(static_cast<double>(scan.ranges_m[beam] - truth.ranges_m[beam]), 2);
      }
    }
  }
  EXPECT_NEAR(lost / all, options.dropout_share, 0.02);
  EXPECT_NEAR(std::sqrt(sum2 / (all - lost)), options.noise_m, 0.05 * options.noise_m);
}

TEST(ScanSimulator, refuses_impossible_lasers) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  const FloorPlan plan;
  const auto refuses = [&](auto member, auto value) {
    ScanSimulatorOptions options;
    options.*member = value;
    EXPECT_THROW(ScanSimulator(plan, options), std::invalid_argument) << value;
  };
  using Options = ScanSimulatorOptions;
  refuses(&Options::beams, std::size_t{1});
  for (const double value : {0.0, -1.0, 2 * M_PI + 1e-9, nan}) refuses(&Options::field_of_view_rad, value);
  for (const double value : {0.0, -0.02, nan}) refuses(&Options::resolution_m, value);
  for (const double value : {0.0, 0.02, infinity, nan}) refuses(&Options::max_range_m, value);
  for (const double value : {-0.01, infinity, nan}) refuses(&Options::noise_m, value);
  refuses(&Options::robot_T_laser, TPose2D(0, nan, 0));
  for (const auto share : {&Options::dropout_share, &Options::glass_return_share, &Options::glass_loss_share})
    for (const double value : {-0.1, 1.1, nan}) refuses(share, value);
  refuses(&Options::glass_return_share, 0.9);  // the sum with glass_loss_share = 0.2 exceeds 1
}

TEST(ScanSimulator, accepts_options_at_their_bounds) {
  const FloorPlan plan;
  ScanSimulatorOptions options;
  options.beams = 2;
  options.field_of_view_rad = 2 * M_PI;
  options.noise_m = 0;
  options.dropout_share = 1;
  options.glass_return_share = 0;
  options.glass_loss_share = 1;
  EXPECT_NO_THROW(ScanSimulator(plan, options));
}

}  // namespace
}  // namespace psi_slam
