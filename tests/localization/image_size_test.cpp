// SPDX-License-Identifier: BSD-3-Clause
#include "localization/image_size.h"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <string>

#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

TEST(ImageSize, agrees_with_the_images_that_opencv_writes) {
  const TemporaryFolder folder;
  for (const char* ending : {"png", "pgm", "bmp", "jpg"}) {
    const auto path = folder.path() / (std::string("map.") + ending);
    cv::imwrite(path.string(), cv::Mat(37, 300, CV_8UC1, cv::Scalar(128)));
    const std::string bytes = read_file(path);
    const auto size = image_size(bytes);
    ASSERT_TRUE(size) << ending;
    EXPECT_EQ(size->width, 300U) << ending;
    EXPECT_EQ(size->height, 37U) << ending;
    for (std::size_t end = 0; end < 9; ++end) EXPECT_FALSE(image_size(bytes.substr(0, end))) << ending << end;
  }
}

TEST(ImageSize, reads_comments_and_large_numbers_of_pnm_files) {
  EXPECT_EQ(image_size("P5\n# by hand\n 12 # columns\n34\n255\n")->height, 34U);
  EXPECT_GT(image_size("P5 1 99999999999999999999999 255\n")->height, 1'000'000'000U);
  EXPECT_FALSE(image_size("P5 x 1 255\n"));
  EXPECT_FALSE(image_size("P5 # endless"));
}

TEST(ImageSize, holds_all_pixels_finds_images_that_are_cut_off) {
  const TemporaryFolder folder;
  for (const char* ending : {"png", "pgm"}) {
    const auto path = folder.path() / (std::string("map.") + ending);
    cv::imwrite(path.string(), cv::Mat(37, 300, CV_8UC1, cv::Scalar(128)));
    const std::string bytes = read_file(path);
    EXPECT_TRUE(holds_all_pixels(bytes)) << ending;
    for (std::size_t end = 9; end < bytes.size(); end += 7)
      EXPECT_FALSE(holds_all_pixels(bytes.substr(0, end))) << ending << end;
  }
  for (const char* whole : {"P1 2 2\n0110", "P2 2 2 9\n0 1 # 2\n3 4\n", "P3 1 1 9\n1 2 3\n", "P4 9 1\nxx",
                            "P5 2 1 255\nxx", "P5 2 1 65535\nxxxx", "P6 1 1 255\nxxx"})
    EXPECT_TRUE(holds_all_pixels(whole)) << whole;
  for (const char* torn :
       {"P1 2 2\n011", "P2 2 2 9\n0 1 3 4", "P2 2 1 9\n0 x\n", "P3 1 1 9\n1 2\n", "P4 9 1\nx",
        "P5 2 1 255\nx", "P5 2 1 65535\nxx", "P6 1 1 255\nxx", "P5 2 1 0\nxx", "P5 2 1 99999\nxxxx", "P5 2"})
    EXPECT_FALSE(holds_all_pixels(torn)) << torn;
}

TEST(ImageSize, is_empty_for_other_files) {
  for (const char* bytes : {"", "GIF89a........", "II*.", "image: map.pgm"}) EXPECT_FALSE(image_size(bytes));
}

}  // namespace
}  // namespace psi_slam
