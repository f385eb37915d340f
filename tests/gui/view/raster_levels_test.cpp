// SPDX-License-Identifier: BSD-3-Clause
#include "gui/raster_levels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace psi_slam {
namespace {

using Bgra = std::array<std::uint8_t, 4>;
constexpr Bgra kInk{20, 20, 20, 255};
constexpr Bgra kPaper{255, 255, 255, 255};
constexpr Bgra kNothing{0, 0, 0, 0};
constexpr Bgra kPaleTint{10, 90, 200, 70};
constexpr Bgra kStrongTint{10, 90, 200, 200};

MapRaster raster_of_pixels(int width_px, const std::vector<Bgra>& pixels) {
  MapRaster raster;
  raster.width_px = width_px;
  raster.height_px = static_cast<int>(pixels.size()) / width_px;
  raster.resolution_m = 0.05;
  raster.x_min_m = -1;
  raster.y_max_m = 2;
  for (const Bgra& pixel : pixels) raster.pixels.insert(raster.pixels.end(), pixel.begin(), pixel.end());
  return raster;
}

Bgra pixel_at(const MapRaster& raster, int row, int column) {
  Bgra pixel{};
  std::copy_n(raster.pixels.begin() + 4 * (row * raster.width_px + column), 4, pixel.begin());
  return pixel;
}

TEST(HalfRaster, keeps_walls_of_one_cell_before_free_before_unknown_space) {
  const MapRaster half = half_raster(raster_of_pixels(4, {kPaper, kPaper, kNothing, kNothing,  //
                                                          kNothing, kInk, kNothing, kPaper}));
  ASSERT_EQ(half.width_px, 2);
  ASSERT_EQ(half.height_px, 1);
  EXPECT_EQ(pixel_at(half, 0, 0), kInk);
  EXPECT_EQ(pixel_at(half, 0, 1), kPaper);
}

TEST(HalfRaster, keeps_the_most_opaque_pixel_of_a_tint) {
  const MapRaster half = half_raster(raster_of_pixels(2, {kPaleTint, kPaleTint, kStrongTint, kNothing}));
  EXPECT_EQ(pixel_at(half, 0, 0), kStrongTint);
}

TEST(HalfRaster, keeps_the_upper_left_corner_and_rounds_the_size_up) {
  const MapRaster raster = raster_of_pixels(3, {kPaper, kPaper, kInk,    //
                                                kPaper, kPaper, kPaper,  //
                                                kPaper, kInk, kNothing});
  const MapRaster half = half_raster(raster);
  ASSERT_EQ(half.width_px, 2);
  ASSERT_EQ(half.height_px, 2);
  EXPECT_EQ(half.resolution_m, 0.1);
  EXPECT_EQ(half.x_min_m, raster.x_min_m);
  EXPECT_EQ(half.y_max_m, raster.y_max_m);
  EXPECT_EQ(pixel_at(half, 0, 0), kPaper);
  EXPECT_EQ(pixel_at(half, 0, 1), kInk);
  EXPECT_EQ(pixel_at(half, 1, 0), kInk);
  EXPECT_EQ(pixel_at(half, 1, 1), kNothing);
}

TEST(HalfRaster, of_an_empty_raster_is_empty) {
  EXPECT_TRUE(half_raster({}).pixels.empty());
}

TEST(RasterLevel, makes_pixels_of_the_raster_at_least_as_wide_as_pixels_of_the_screen) {
  EXPECT_EQ(raster_level(0.05, 0.01), 0) << "a cell covers several pixels of the screen";
  EXPECT_EQ(raster_level(0.05, 0.05), 0);
  EXPECT_EQ(raster_level(0.05, 0.06), 1);
  EXPECT_EQ(raster_level(0.05, 0.10), 1);
  EXPECT_EQ(raster_level(0.05, 0.11), 2);
  EXPECT_EQ(raster_level(0.05, 0), 0) << "the size of a pixel is not known";
}

}  // namespace
}  // namespace psi_slam
