// SPDX-License-Identifier: BSD-3-Clause
#include "gui/map_camera.h"

#include <gtest/gtest.h>

#include <cmath>

namespace psi_slam {
namespace {

const mrpt::img::TImageSize kSize(800, 400);

TEST(MapCamera, looking_straight_down_x_points_right_and_y_up) {
  MapCamera camera;
  camera.target = {3, -2};
  const double half_height_m = camera.distance_m * std::tan(camera.field_of_view_deg * M_PI / 360);
  const auto middle = ground_at(camera, kSize, 400, 200);
  ASSERT_TRUE(middle.has_value());
  EXPECT_NEAR(middle->x, 3, 1e-9);
  EXPECT_NEAR(middle->y, -2, 1e-9);
  const auto corner = ground_at(camera, kSize, 800, 0);
  ASSERT_TRUE(corner.has_value());
  EXPECT_NEAR(corner->x, 3 + 2 * half_height_m, 1e-9);
  EXPECT_NEAR(corner->y, -2 + half_height_m, 1e-9);
}

TEST(MapCamera, when_tilted_the_upper_edge_is_farther_away_and_the_sky_shows_no_ground) {
  MapCamera camera;
  camera.elevation_deg = 40;
  const auto above = ground_at(camera, kSize, 400, 0);
  const auto below = ground_at(camera, kSize, 400, 400);
  ASSERT_TRUE(above && below);
  EXPECT_GT(above->y, -below->y) << "the same distance in pixels shows more ground farther away";
  EXPECT_NEAR(above->x, 0, 1e-9);
  camera.elevation_deg = 10;
  EXPECT_FALSE(ground_at(camera, kSize, 400, 0).has_value());
}

TEST(MapCamera, a_pixel_shows_the_ground_between_its_neighbours) {
  MapCamera camera;
  const auto left = ground_at(camera, kSize, 399.5, 200);
  const auto right = ground_at(camera, kSize, 400.5, 200);
  ASSERT_TRUE(left && right);
  EXPECT_NEAR(ground_pixel_m(camera, kSize), right->x - left->x, 1e-9);
  camera.elevation_deg = 30;
  const auto above = ground_at(camera, kSize, 400, 199.5);
  const auto below = ground_at(camera, kSize, 400, 200.5);
  ASSERT_TRUE(above && below);
  EXPECT_NEAR(ground_pixel_m(camera, kSize), above->y - below->y, 1e-4) << "a tilted camera sees farther";
}

TEST(MapCamera, looking_straight_down_sees_the_whole_rectangle) {
  for (const MapRectangle& rectangle :
       {MapRectangle{-10, 50, 0, 5}, MapRectangle{0, 4, -30, 30}, MapRectangle{1, 1, 1, 1}}) {
    const MapCamera camera = camera_above(rectangle, kSize);
    const auto upper_left = ground_at(camera, kSize, 0, 0);
    const auto lower_right = ground_at(camera, kSize, kSize.x, kSize.y);
    ASSERT_TRUE(upper_left && lower_right);
    EXPECT_LT(upper_left->x, rectangle.x_min_m);
    EXPECT_GT(upper_left->y, rectangle.y_max_m);
    EXPECT_GT(lower_right->x, rectangle.x_max_m);
    EXPECT_LT(lower_right->y, rectangle.y_min_m);
  }
}

}  // namespace
}  // namespace psi_slam
