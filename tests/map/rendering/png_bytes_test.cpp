// SPDX-License-Identifier: BSD-3-Clause
#include "map/rendering/png_bytes.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

/// Returns an image of 31 x 17 pixels with this number of colours, which differ in all channels.
cv::Mat image_with(unsigned colours, int channels) {
  cv::Mat image(17, 31, CV_8UC(channels));
  unsigned number = 0;
  for (int y = 0; y < image.rows; ++y) {
    std::uint8_t* pixel = image.ptr(y);
    for (int x = 0; x < image.cols; ++x, pixel += channels, number = (number + 1) % colours) {
      pixel[0] = static_cast<std::uint8_t>(number);
      pixel[1] = static_cast<std::uint8_t>(255 - number);
      pixel[2] = static_cast<std::uint8_t>(number / 256 * 100);
      if (channels == 4) pixel[3] = static_cast<std::uint8_t>(number % 3 * 127);
    }
  }
  return image;
}

bool has_palette(const std::string& png) {
  constexpr std::size_t kColourType = 25;  // its place in the header
  constexpr char kPalette = 3;
  return png.at(kColourType) == kPalette;
}

TEST(PngBytes, keep_every_pixel) {
  for (const int channels : {3, 4})
    for (const unsigned colours : {1U, 2U, 5U, 17U, 256U, 257U, 400U}) {
      const cv::Mat image = image_with(colours, channels);
      const std::string png = png_bytes(image.clone());
      const cv::Mat read = cv::imdecode(std::vector<char>(png.begin(), png.end()), cv::IMREAD_UNCHANGED);
      ASSERT_EQ(read.type(), image.type()) << colours << " colours";
      EXPECT_EQ(cv::norm(read, image, cv::NORM_INF), 0) << colours << " colours, " << channels << " channels";
      EXPECT_EQ(has_palette(png), colours <= 256) << colours << " colours";
    }
}

TEST(PngBytes, of_a_part_of_an_image_are_those_of_its_copy) {
  const cv::Mat part = image_with(9, 3).colRange(3, 20);
  ASSERT_FALSE(part.isContinuous());
  const cv::Mat copy = part.clone();
  EXPECT_EQ(png_bytes(cv::Mat(part)), png_bytes(part.clone()));
  EXPECT_EQ(cv::norm(part, copy, cv::NORM_INF), 0);
}

TEST(PngBytes, have_no_opacity_if_all_colours_are_opaque) {
  const cv::Mat image(5, 4, CV_8UC4, cv::Scalar(10, 20, 30, 255));
  const std::string png = png_bytes(image.clone());
  const cv::Mat read = cv::imdecode(std::vector<char>(png.begin(), png.end()), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(read.type(), CV_8UC3);
  EXPECT_EQ(read.at<cv::Vec3b>(2, 3), cv::Vec3b(10, 20, 30));
}

TEST(PngBytes, of_other_channels_are_refused) {
  EXPECT_THROW(png_bytes(cv::Mat(5, 4, CV_8UC1, cv::Scalar(0))), std::invalid_argument);
  EXPECT_THROW(png_bytes(cv::Mat(5, 4, CV_16UC3, cv::Scalar(0))), std::invalid_argument);
}

TEST(PngBytes, of_an_image_without_pixels_are_refused) {
  EXPECT_THROW(png_bytes(cv::Mat(0, 0, CV_8UC3)), SystemFailure);
}

}  // namespace
}  // namespace psi_slam
