// SPDX-License-Identifier: BSD-3-Clause
#include "matching/surface_alignment.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "../mapping/local_maps/simulated_drive.h"
#include "mapping/local_maps/scan_filter.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

ScanPoints scan_at(const SimulatedWalls& walls, const TPose2D& map_T_robot, double noise_m,
                   std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const BeamBearings bearings = even_bearings(-M_PI / 2, M_PI / 2, 181);
  return matching_points(simulated_scan(walls, map_T_robot, bearings, {0.1, 0, 0}, noise_m, random), {});
}

// Surfaces seen from several poses in a room, placed at the true poses.
class SeenRoom {
 public:
  SeenRoom(const SimulatedWalls& walls, const std::vector<TPose2D>& poses, double noise_m) {
    std::uint64_t seed = 100;
    for (const TPose2D& pose : poses) seen_.push_back(surface_points(scan_at(walls, pose, noise_m, ++seed)));
    std::vector<SurfaceMap::Part> parts;
    for (std::size_t i = 0; i < poses.size(); ++i) parts.push_back({&seen_[i], poses[i]});
    map_ = std::make_unique<SurfaceMap>(parts);
  }
  const SurfaceMap& map() const { return *map_; }

 private:
  std::vector<SurfacePoints> seen_;
  std::unique_ptr<SurfaceMap> map_;
};

const std::vector<TPose2D> kViews = {{3, 2, 0.5}, {3.2, 2.1, 0.7}, {3.5, 2.4, 0.3}, {2.8, 1.9, 0.4}};

// Returns the cost without the prior: the sum of the robust kernel rho over all points. Finds near points by
// comparing all pairs.
double slow_cost(const SurfaceMap& map, const SurfacePoints& scan, const TPose2D& pose,
                 const SurfaceAlignmentOptions& options) {
  const auto& surface = map.index().points();
  double cost = 0;
  for (std::size_t j = 0; j < scan.points.size(); ++j) {
    const Eigen::Rotation2Df turn(static_cast<float>(pose.phi));
    const Eigen::Vector2f at = turn * Eigen::Vector2f(scan.points[j].x, scan.points[j].y) +
                               Eigen::Vector2f(static_cast<float>(pose.x), static_cast<float>(pose.y));
    const Eigen::Vector2f facing = turn * Eigen::Vector2f(scan.normals[j].x, scan.normals[j].y);
    std::vector<std::pair<float, std::size_t>> near;
    for (std::size_t k = 0; k < surface.size(); ++k)
      near.emplace_back((at - Eigen::Vector2f(surface[k].x, surface[k].y)).norm(), k);
    std::sort(near.begin(), near.end());
    near.resize(options.neighbours);
    Eigen::Vector2f point_sum(0, 0);
    Eigen::Vector2f normal_sum(0, 0);
    float count = 0;
    for (const auto& [distance, k] : near) {
      const Eigen::Vector2f normal(map.normals()[k].x, map.normals()[k].y);
      const double turned = std::acos(std::min(1.0F, normal.dot(facing)));
      if (static_cast<double>(distance) > options.max_distance_m || turned > options.max_turn_rad) continue;
      point_sum += Eigen::Vector2f(surface[k].x, surface[k].y);
      normal_sum += normal;
      ++count;
    }
    if (count == 0) continue;
    const float residual = normal_sum.normalized().dot(at - point_sum / count);
    const double square = std::pow(static_cast<double>(residual) / options.kernel_m, 2);
    cost += square / (1 + square);
  }
  return cost;
}

TEST(SurfacePoints, face_the_laser) {
  const SurfacePoints seen = surface_points(scan_at(furnished_room(), {3, 2, 0.5}, 0, 1));
  ASSERT_GT(seen.points.size(), 100U);
  ASSERT_EQ(seen.points.size(), seen.normals.size());
  for (std::size_t i = 0; i < seen.points.size(); ++i) {
    EXPECT_NEAR(std::hypot(seen.normals[i].x, seen.normals[i].y), 1, 1e-5);
    EXPECT_LE(seen.normals[i].x * (seen.points[i].x - 0.1F) + seen.normals[i].y * seen.points[i].y, 0);
  }
}

TEST(SurfaceAlignment, moves_a_scan_to_its_true_pose) {
  const SimulatedWalls walls = furnished_room();
  const SeenRoom room(walls, kViews, 0.005);
  const TPose2D truth(3.1, 2.2, 0.55);
  const SurfacePoints scan = surface_points(scan_at(walls, truth, 0.005, 7));
  SurfaceAlignmentOptions options;
  options.prior_sigma_m = 1;  // a weak prior, which hardly matters
  options.prior_sigma_rad = 1;
  options.iterations = 10;
  for (const TPose2D& off : {TPose2D(0.04, 0, 0), TPose2D(-0.02, 0.03, 0.01), TPose2D(0, -0.04, -0.015)}) {
    const TPose2D start = truth + off;
    const SurfaceAlignment found = align_to_surfaces(room.map(), scan, start, start, options);
    EXPECT_GT(found.points, 100U);
    EXPECT_NEAR(found.map_T_robot.x, truth.x, 0.004);
    EXPECT_NEAR(found.map_T_robot.y, truth.y, 0.004);
    EXPECT_NEAR(found.map_T_robot.phi, truth.phi, 0.0015);
  }
}

TEST(SurfaceAlignment, hardly_changes_if_surfaces_are_searched_again_at_every_iteration) {
  const SimulatedWalls walls = furnished_room();
  const SeenRoom room(walls, kViews, 0.01);
  const SurfaceAlignmentOptions options;
  SurfaceAlignmentOptions thorough;
  thorough.search_again_m = 0;
  bool differs = false;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> off(-0.02, 0.02);
    const TPose2D truth(3.1, 2.2, 0.55);
    const SurfacePoints scan = surface_points(scan_at(walls, truth, 0.01, seed));
    const TPose2D start = truth + TPose2D(off(random), off(random), off(random) / 4);
    const TPose2D fast = align_to_surfaces(room.map(), scan, start, start, options).map_T_robot;
    const TPose2D slow = align_to_surfaces(room.map(), scan, start, start, thorough).map_T_robot;
    EXPECT_NEAR(fast.x, slow.x, 3e-4);
    EXPECT_NEAR(fast.y, slow.y, 3e-4);
    EXPECT_NEAR(fast.phi, slow.phi, 1e-4);
    differs = differs || fast.x != slow.x;
  }
  EXPECT_TRUE(differs) << "no search was saved, so nothing was tested";
}

TEST(SurfaceAlignment, ends_at_a_minimum_of_the_cost) {
  const SimulatedWalls walls = furnished_room();
  const SeenRoom room(walls, kViews, 0.01);
  const SurfacePoints scan = surface_points(scan_at(walls, {3.1, 2.2, 0.55}, 0.01, 7));
  SurfaceAlignmentOptions options;
  options.prior_sigma_m = 100;
  options.prior_sigma_rad = 100;
  options.iterations = 30;
  const TPose2D start(3.12, 2.19, 0.555);
  const TPose2D pose = align_to_surfaces(room.map(), scan, start, start, options).map_T_robot;
  const double least = slow_cost(room.map(), scan, pose, options);
  EXPECT_LT(least, slow_cost(room.map(), scan, start, options));
  for (int axis = 0; axis < 3; ++axis)
    for (const double step : {-0.01, 0.01}) {
      TPose2D aside = pose;
      (axis == 0 ? aside.x : axis == 1 ? aside.y : aside.phi) += axis == 2 ? 0.4 * step : step;
      EXPECT_GT(slow_cost(room.map(), scan, aside, options), least) << "axis " << axis << ", " << step;
    }
}

TEST(SurfaceAlignment, along_a_corridor_stays_at_the_prior) {
  SimulatedWalls corridor;
  corridor.add_wall(-60, -1, 60, -1);
  corridor.add_wall(-60, 1, 60, 1);
  const SeenRoom seen(corridor, {{-1, 0, 0}, {0.2, 0, 0}, {1, 0, 0}}, 0.005);
  const SurfacePoints scan = surface_points(scan_at(corridor, {0, 0, 0}, 0.005, 9));
  const TPose2D start(0.03, 0.03, 0.01);
  const TPose2D pose = align_to_surfaces(seen.map(), scan, start, start, {}).map_T_robot;
  EXPECT_NEAR(pose.x, start.x, 0.003);  // only the prior determines x
  EXPECT_NEAR(pose.y, 0, 0.004);
  EXPECT_NEAR(pose.phi, 0, 0.002);
}

TEST(SurfaceAlignment, keeps_the_start_with_too_few_points_near_surfaces) {
  const SimulatedWalls walls = furnished_room();
  const SeenRoom room(walls, kViews, 0);
  SimulatedWalls elsewhere;
  elsewhere.add_box(100, 100, 108, 106);
  const SurfacePoints scan = surface_points(scan_at(elsewhere, {104, 103, 0}, 0, 3));
  const TPose2D start(104, 103, 0);
  const SurfaceAlignment found = align_to_surfaces(room.map(), scan, start, start, {});
  EXPECT_EQ(found.points, 0U);
  EXPECT_EQ(found.map_T_robot, start);
  const SurfaceMap nothing({});
  EXPECT_EQ(align_to_surfaces(nothing, scan, start, start, {}).map_T_robot, start);
  EXPECT_EQ(align_to_surfaces(room.map(), {}, start, start, {}).map_T_robot, start);
}

TEST(SurfaceAlignment, does_not_match_opposite_sides_of_a_wall) {
  SimulatedWalls thin;  // a wall of 6 cm between two rooms
  thin.add_box(-4, 0.06, 4, 5);
  thin.add_box(-4, -5, 4, 0);
  const SeenRoom upper(thin, {{0, 2, -M_PI / 2}}, 0);
  const SurfacePoints scan = surface_points(scan_at(thin, {0, -2, M_PI / 2}, 0, 3));
  const SurfaceAlignment found =
      align_to_surfaces(upper.map(), scan, {0, -2, M_PI / 2}, {0, -2, M_PI / 2}, {});
  EXPECT_NEAR(found.map_T_robot.y, -2, 1e-3);
}

TEST(SurfacePoints, face_the_laser_that_saw_them) {
  ScanPoints scan;
  scan.origin = {2, 0};
  scan.points = {{1, 0}, {1, 0}};
  scan.normals = {{1, 0}, {1, 0}};
  scan.other_lasers.push_back({1, {-2, 0}});  // this laser is on the other side of the wall
  const SurfacePoints surfaces = surface_points(scan);
  ASSERT_EQ(surfaces.normals.size(), 2U);
  EXPECT_EQ(surfaces.normals[0].x, 1.0F);
  EXPECT_EQ(surfaces.normals[1].x, -1.0F);
}

}  // namespace
}  // namespace psi_slam
