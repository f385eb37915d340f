// SPDX-License-Identifier: BSD-3-Clause
#include "map/rendering/map_image.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "map/rendering/picture_ink.h"

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;

/// Returns a map of 3 m x 2 m with its lower left corner at (-1.5, 4) m and cells of 0.25 m. The 2 m x 1 m at
/// this corner are free, except for one cell with its lower left corner at (-0.5, 4.25) m.
COccupancyGridMap2D lopsided_map() {
  COccupancyGridMap2D grid(-1.5F, 1.5F, 4, 6, 0.25F);
  for (int x = 0; x < 8; ++x)
    for (int y = 0; y < 4; ++y) grid.setCell(x, y, 0.99F);
  grid.setCell(4, 1, 0.01F);
  return grid;
}

/// Fields of the header of a PNG file.
struct PngHeader {
  std::uint32_t width;
  std::uint32_t height;
};

PngHeader header_of(const std::string& png) {
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(png.at(at + i));
    return value;
  };
  EXPECT_EQ(png.substr(1, 3), "PNG");
  return {number(16), number(20)};
}

cv::Mat decoded(const std::string& png) {
  return cv::imdecode(std::vector<char>(png.begin(), png.end()), cv::IMREAD_UNCHANGED);
}

MapPictureOptions plain() {
  MapPictureOptions options;
  options.min_side_px = 1;
  options.margin_m = 0;
  options.scale_bar = false;
  return options;
}

TEST(MapImage, has_the_thresholds_of_map_server) {
  for (int i = std::numeric_limits<COccupancyGridMap2D::cellType>::min();
       i <= std::numeric_limits<COccupancyGridMap2D::cellType>::max(); ++i) {
    const auto cell = static_cast<COccupancyGridMap2D::cellType>(i);
    EXPECT_EQ(is_occupied(cell), COccupancyGridMap2D::l2p(cell) < 0.35F) << i;
    EXPECT_EQ(is_free(cell), COccupancyGridMap2D::l2p(cell) > 0.804F) << i;
  }
}

TEST(MapImage, counts_what_was_seen_and_where) {
  const SeenCells seen = seen_cells(lopsided_map());
  EXPECT_EQ(seen.x_begin, 0);
  EXPECT_EQ(seen.x_end, 8);
  EXPECT_EQ(seen.y_begin, 0);
  EXPECT_EQ(seen.y_end, 4);
  EXPECT_EQ(seen.free, 31U);
  EXPECT_EQ(seen.occupied, 1U);
}

TEST(MapImage, is_cropped_to_the_seen_part_and_its_margin) {
  const MapPicture bare = map_picture(lopsided_map(), plain());
  EXPECT_EQ(bare.width_px, 8);
  EXPECT_EQ(bare.height_px, 4);
  EXPECT_NEAR(bare.x_min_m, -1.5, 1e-6);
  EXPECT_NEAR(bare.y_max_m, 5, 1e-6);
  EXPECT_NEAR(bare.resolution_m, 0.25, 1e-6);
  const PngHeader header = header_of(bare.png);
  EXPECT_EQ(header.width, 8U);
  EXPECT_EQ(header.height, 4U);
  EXPECT_EQ(decoded(bare.png).channels(), 3) << "without opacity";

  MapPictureOptions wide = plain();
  wide.margin_m = 0.5;
  const MapPicture framed = map_picture(lopsided_map(), wide);
  EXPECT_EQ(framed.width_px, 12);
  EXPECT_NEAR(framed.x_min_m, -2, 1e-6);
  EXPECT_NEAR(framed.y_max_m, 5.5, 1e-6);
}

TEST(MapImage, shows_walls_free_and_unknown_space_in_their_colours) {
  const auto opaque = [](const Pixel& ink) { return cv::Vec3b(ink[0], ink[1], ink[2]); };
  MapPictureOptions options = plain();
  options.margin_m = 0.5;  // two cells, which lie beyond the grid on the left and below
  const cv::Mat image = decoded(map_picture(lopsided_map(), options).png);
  EXPECT_EQ(image.at<cv::Vec3b>(4, 6), opaque(kWallInk));
  EXPECT_EQ(image.at<cv::Vec3b>(4, 5), opaque(kFreeInk));
  EXPECT_EQ(image.at<cv::Vec3b>(0, 11), opaque(kUnknownInk)) << "within the grid";
  EXPECT_EQ(image.at<cv::Vec3b>(0, 0), opaque(kUnknownInk)) << "left of the grid";
  EXPECT_EQ(image.at<cv::Vec3b>(7, 6), opaque(kUnknownInk)) << "below the grid";
}

TEST(MapImage, small_maps_are_enlarged_and_large_ones_reduced_by_whole_numbers) {
  MapPictureOptions options = plain();
  options.min_side_px = 100;
  const MapPicture larger = map_picture(lopsided_map(), options);
  EXPECT_EQ(larger.width_px, 8 * 13);
  EXPECT_NEAR(larger.resolution_m, 0.25 / 13, 1e-9);
  options.min_side_px = 1;
  options.max_side_px = 3;
  const MapPicture smaller = map_picture(lopsided_map(), options);
  EXPECT_EQ(smaller.width_px, 3);
  EXPECT_NEAR(smaller.resolution_m, 0.75, 1e-6);
}

TEST(MapImage, scale_bar_has_its_own_strip) {
  MapPictureOptions options;
  const MapPicture with_bar = map_picture(lopsided_map(), options);
  options.scale_bar = false;
  EXPECT_GT(with_bar.height_px, map_picture(lopsided_map(), options).height_px);
}

TEST(MapImage, unknown_space_can_be_transparent) {
  MapPictureOptions options = plain();
  options.transparent_unknown = true;
  options.margin_m = 0.25;  // one pixel
  const cv::Mat image = decoded(map_picture(lopsided_map(), options).png);
  ASSERT_EQ(image.channels(), 4) << "with opacity";
  EXPECT_EQ(image.at<cv::Vec4b>(0, 0)[3], 0) << "unknown";
  EXPECT_EQ(image.at<cv::Vec4b>(1, 1)[3], 255) << "free";
}

TEST(MapImage, empty_maps_give_pictures_and_equal_maps_equal_bytes) {
  const COccupancyGridMap2D nothing(-1, 1, -1, 1, 0.25F);
  EXPECT_EQ(map_picture(nothing, plain()).width_px, 8);
  EXPECT_EQ(map_picture(lopsided_map()).png, map_picture(lopsided_map()).png);
}

}  // namespace
}  // namespace psi_slam
