// SPDX-License-Identifier: BSD-3-Clause
#include "matching/point_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/random_draws.h"

namespace psi_slam {
namespace {

using Point = mrpt::math::TPoint2Df;

std::vector<Point> drawn_points(std::size_t count) {
  RandomDraws random(5, "points", 0);
  std::vector<Point> points;
  for (std::size_t i = 0; i < count; ++i)
    points.emplace_back(static_cast<float>(random.plus_minus(4)), static_cast<float>(random.plus_minus(4)));
  return points;
}

float distance_m(const Point& a, const Point& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

std::vector<std::size_t> slow_within(const std::vector<Point>& points, const Point& at, float radius_m) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (distance_m(points[i], at) <= radius_m) found.push_back(i);
  return found;
}

TEST(PointIndex, equals_a_search_through_all_points) {
  const std::vector<Point> points = drawn_points(700);
  const PointIndex index(points);
  for (const Point& at : drawn_points(60)) {
    const Point query = at + Point(0.01F, 0.02F);
    for (const float reach : {0.05F, 0.4F, 20.0F})
      EXPECT_EQ(index.within(query, reach), slow_within(points, query, reach));
  }
}

TEST(PointIndex, finds_nothing_without_points) {
  const PointIndex index(std::vector<Point>{});
  EXPECT_TRUE(index.within({0, 0}, 10).empty());
}

TEST(PointIndex, includes_points_at_the_radius) {
  const PointIndex index({{0, 0}, {0.5F, 0}, {0, -0.5F}, {0.5625F, 0}});
  EXPECT_EQ(index.within({0, 0}, 0.5F), (std::vector<std::size_t>{0, 1, 2}));
}

TEST(PointIndex, works_after_a_move) {
  PointIndex first(drawn_points(50));
  const PointIndex second(std::move(first));
  EXPECT_EQ(second.within({0, 0}, 2), slow_within(drawn_points(50), {0, 0}, 2));
}

}  // namespace
}  // namespace psi_slam
