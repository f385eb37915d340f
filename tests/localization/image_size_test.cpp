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

TEST(ImageSize, is_empty_for_other_files) {
  for (const char* bytes : {"", "GIF89a........", "II*.", "image: map.pgm"}) EXPECT_FALSE(image_size(bytes));
}

}  // namespace
}  // namespace psi_slam
