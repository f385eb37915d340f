// SPDX-License-Identifier: BSD-3-Clause
#include "matching/point_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/random_draws.h"

namespace psi_slam {
namespace {

using Point = mrpt::math::TPoint2Df;

std::vector<Point> scattered_points(std::size_t count, double extent_m) {
  RandomDraws random(5, "points", 0);
  std::vector<Point> points;
  for (std::size_t i = 0; i < count; ++i)
    points.emplace_back(static_cast<float>(random.plus_minus(extent_m)),
                        static_cast<float>(random.plus_minus(extent_m)));
  return points;
}

float square_m2(const Point& a, const Point& b) {
  const float dx = a.x - b.x;
  const float dy = a.y - b.y;
  return dx * dx + dy * dy;
}

std::vector<std::uint32_t> slow_within(const std::vector<Point>& points, const Point& at, float radius_m) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < points.size(); ++i)
    if (square_m2(points[i], at) <= radius_m * radius_m) found.push_back(i);
  return found;
}

std::vector<std::uint32_t> slow_nearest(const std::vector<Point>& points, const Point& at, std::size_t count,
                                        float max_distance_m) {
  std::vector<std::uint32_t> found = slow_within(points, at, max_distance_m);
  std::stable_sort(found.begin(), found.end(), [&](std::uint32_t a, std::uint32_t b) {
    return square_m2(points[a], at) < square_m2(points[b], at);
  });
  found.resize(std::min(found.size(), count));
  return found;
}

// The cells repeat after 64 times their size, so the extents are within one period, and several.
TEST(PointGrid, equals_a_search_through_all_points) {
  for (const double extent_m : {0.6, 4.0, 30.0}) {
    const std::vector<Point> points = scattered_points(700, extent_m);
    std::vector<std::uint32_t> near;
    for (const double cell_m : {0.02, 0.07, 1.0}) {
      const PointGrid grid(points, cell_m);
      for (const Point& at : scattered_points(40, extent_m)) {
        const Point query = at + Point(0.01F, 0.02F);
        for (const float reach : {0.05F, 0.4F, 2.2F, 20.0F})
          for (const std::size_t count : {1U, 6U, 900U}) {
            grid.nearest(query, count, reach, near);
            EXPECT_EQ(near, slow_nearest(points, query, count, reach))
                << count << " within " << reach << " of " << extent_m << ", cells of " << cell_m;
          }
        for (const float reach : {0.05F, 0.4F, 2.2F, 20.0F})
          EXPECT_EQ(grid.within(query, reach), slow_within(points, query, reach))
              << reach << " of " << cell_m;
      }
    }
  }
}

TEST(PointGrid, finds_nothing_without_points) {
  const PointGrid grid({}, 0.1);
  std::vector<std::uint32_t> near = {1, 2};
  grid.nearest({0, 0}, 3, 10, near);
  EXPECT_TRUE(near.empty());
  EXPECT_TRUE(grid.within({0, 0}, 10).empty());
}

TEST(PointGrid, includes_points_at_the_largest_distance) {
  const std::vector<Point> points = {{0, 0}, {0.5F, 0}, {0, -0.5F}, {0.5625F, 0}, {2, 0.5F}};
  for (const double cell_m : {0.1, 0.25, 1.0}) {
    const PointGrid grid(points, cell_m);
    std::vector<std::uint32_t> near;
    grid.nearest({0, 0}, 4, 0.5F, near);
    EXPECT_EQ(near, (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_EQ(grid.within({0, 0}, 0.5F), near);
    grid.nearest({0.5F, 0.5F}, 9, 1.5F, near);
    EXPECT_EQ(near, slow_nearest(points, {0.5F, 0.5F}, 9, 1.5F));
    EXPECT_EQ(grid.within({0.5F, 0.5F}, 1.5F), slow_within(points, {0.5F, 0.5F}, 1.5F));
  }
}

TEST(PointGrid, finds_only_points_at_the_place_itself_within_no_distance) {
  const PointGrid grid({{0.5F, 0}, {0.5F, 0}, {0.5F, 0.001F}}, 0.1);
  std::vector<std::uint32_t> near;
  grid.nearest({0.5F, 0}, 4, 0, near);
  EXPECT_EQ(near, (std::vector<std::uint32_t>{0, 1}));
  grid.nearest({0.5F, 0.002F}, 4, 0, near);
  EXPECT_TRUE(near.empty());
}

// So the size of the cells changes no result.
TEST(PointGrid, orders_equally_near_points_by_their_indices) {
  for (const double cell_m : {0.0625, 0.3, 1.0}) {
    const PointGrid grid({{0.125F, 0}, {-0.125F, 0}, {0, 0.125F}, {0, -0.125F}, {0.125F, 0}}, cell_m);
    std::vector<std::uint32_t> near;
    grid.nearest({0, 0}, 3, 1, near);
    EXPECT_EQ(near, (std::vector<std::uint32_t>{0, 1, 2}));
  }
}

}  // namespace
}  // namespace psi_slam
