// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/local_maps/surface_normals.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <optional>
#include <random>
#include <vector>

namespace psi_slam {
namespace {

using Point = mrpt::math::TPoint2Df;

/// Points of a scan from (0, 0): walls and gaps at random ranges, with noise.
std::vector<Point> random_scan(std::mt19937_64& random, std::size_t count) {
  std::uniform_real_distribution<double> share(0, 1);
  std::normal_distribution<double> noise_m(0, 0.02);
  std::vector<Point> points;
  double range_m = 3;
  double slope = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double bearing_rad = 2 * M_PI * static_cast<double>(i) / static_cast<double>(count);
    if (share(random) < 0.1) range_m = 0.5 + 8 * share(random);
    if (share(random) < 0.2) slope = share(random) - 0.5;
    range_m = std::max(0.3, range_m + 0.2 * slope);
    const double seen_m = range_m + noise_m(random);
    points.emplace_back(static_cast<float>(seen_m * std::cos(bearing_rad)),
                        static_cast<float>(seen_m * std::sin(bearing_rad)));
  }
  return points;
}

bool goes_on(const Point& from, const Point& to) {
  const double gap_m = std::hypot(static_cast<double>(from.x - to.x), static_cast<double>(from.y - to.y));
  const double range_m = std::hypot(static_cast<double>(from.x), static_cast<double>(from.y));
  return gap_m <= std::max(0.4, 0.15 * range_m);
}

/// The line through some points: the eigenvectors of their covariance.
struct Line {
  Eigen::Vector2d normal;
  double residual_m;
};

/// Walks from a point to both sides, and fits a line. Returns nothing for fewer than four points.
std::optional<Line> line_through(const std::vector<Point>& points, std::size_t index, bool is_ring,
                                 bool with_point) {
  const auto size = static_cast<std::ptrdiff_t>(points.size());
  const auto i = static_cast<std::ptrdiff_t>(index);
  std::vector<std::ptrdiff_t> chosen{i};
  for (const int step : {-1, 1})
    for (std::ptrdiff_t k = i; std::abs(k + step - i) <= 3; k += step) {
      const std::ptrdiff_t next = k + step;
      if (!is_ring && (next < 0 || next >= size)) break;
      const auto at = [&](std::ptrdiff_t n) { return points[static_cast<std::size_t>((n + size) % size)]; };
      if (!goes_on(at(k), at(next))) break;
      chosen.push_back((next + size) % size);
    }
  if (chosen.size() < 4) return std::nullopt;
  if (!with_point) chosen.erase(chosen.begin());
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  for (const std::ptrdiff_t k : chosen) {
    const Point& point = points[static_cast<std::size_t>(k)];
    const Eigen::Vector2d at(static_cast<double>(point.x), static_cast<double>(point.y));
    mean += at;
    squares += at * at.transpose();
  }
  const auto count = static_cast<double>(chosen.size());
  mean /= count;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(squares / count - mean * mean.transpose());
  return Line{solver.eigenvectors().col(0), std::sqrt(std::max(0.0, solver.eigenvalues()[0]))};
}

TEST(SurfaceNormals, are_those_of_lines_through_the_neighbours_one_by_one) {
  constexpr double kMaxResidual_m = 0.04;
  std::mt19937_64 random(1);
  int lines = 0;
  int others = 0;
  for (int scan = 0; scan < 20; ++scan) {
    const std::vector<Point> points = random_scan(random, 180);
    const auto compare = [&](const std::vector<Point>& normals, bool is_ring, bool with_point) {
      ASSERT_EQ(normals.size(), points.size());
      for (std::size_t i = 0; i < points.size(); ++i) {
        const auto line = line_through(points, i, is_ring, with_point);
        if (line && std::abs(line->residual_m - kMaxResidual_m) < 1e-4) continue;  // rounding decides
        if (!line || line->residual_m > kMaxResidual_m) {
          EXPECT_EQ(normals[i], Point(0, 0)) << "scan " << scan << ", point " << i;
          ++others;
          continue;
        }
        const Eigen::Vector2d normal(static_cast<double>(normals[i].x), static_cast<double>(normals[i].y));
        EXPECT_NEAR(std::abs(normal.dot(line->normal)), 1, 1e-4) << "scan " << scan << ", point " << i;
        ++lines;
      }
    };
    compare(surface_normals(points, true), true, true);
    compare(surface_normals(points, false), false, true);
    compare(normals_of_neighbours(points), false, false);
  }
  EXPECT_GT(lines, 1000);
  EXPECT_GT(others, 1000);
}

std::vector<Point> points_of_a_wall(std::size_t count) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < count; ++i) points.emplace_back(1, 0.1F * static_cast<float>(i));
  return points;
}

TEST(SurfaceNormals, fewer_than_four_points_have_none) {
  for (const std::size_t count : {0U, 1U, 2U, 3U}) {
    const std::vector<Point> points = points_of_a_wall(count);
    const std::vector<Point> none(count, Point(0, 0));
    EXPECT_EQ(surface_normals(points, false), none);
    EXPECT_EQ(surface_normals(points, true), none);
    EXPECT_EQ(normals_of_neighbours(points), none);
  }
}

TEST(SurfaceNormals, a_small_ring_uses_each_point_once) {
  for (const std::size_t count : {4U, 5U, 6U, 7U, 8U})
    for (const bool is_ring : {false, true})
      for (const Point& normal : surface_normals(points_of_a_wall(count), is_ring)) {
        EXPECT_NEAR(std::abs(normal.x), 1, 1e-5) << count << " points";
        EXPECT_NEAR(normal.y, 0, 1e-5) << count << " points";
      }
}

}  // namespace
}  // namespace psi_slam
