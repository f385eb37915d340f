// SPDX-License-Identifier: BSD-3-Clause
#include "localization/comparison/change_picture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>

#include "drawn_plan.h"

namespace psi_slam {
namespace {

std::size_t pixels_of(const cv::Mat& image, const cv::Vec3b& colour, int above_row) {
  std::size_t count = 0;
  for (int row = 0; row < above_row; ++row)
    count += static_cast<std::size_t>(
        std::count(image.ptr<cv::Vec3b>(row), image.ptr<cv::Vec3b>(row) + image.cols, colour));
  return count;
}

TEST(ChangePicture, shows_new_walls_in_blue_and_old_ones_in_orange) {
  DrawnPlan plan;
  plan.walls.push_back({{1, 3}, {4, 3}});
  const WallChanges appeared = find_wall_changes(map_of({}), map_of(plan), {0, 0, 0});
  const WallChanges vanished = find_wall_changes(map_of(plan), map_of({}), {0, 0, 0});
  const auto counts = [](const WallChanges& walls) {
    const std::string png = change_picture(walls);
    const cv::Mat image = cv::imdecode(std::vector<char>(png.begin(), png.end()), cv::IMREAD_COLOR);
    const int map_rows = image.rows - 60;  // without the legend
    return std::make_pair(pixels_of(image, {178, 114, 0}, map_rows),
                          pixels_of(image, {0, 94, 213}, map_rows));
  };
  const auto [new_blue, new_orange] = counts(appeared);
  EXPECT_GT(new_blue, 500U);
  EXPECT_EQ(new_orange, 0U);
  const auto [old_blue, old_orange] = counts(vanished);
  EXPECT_EQ(old_blue, 0U);
  EXPECT_GT(old_orange, 500U);
}

}  // namespace
}  // namespace psi_slam
