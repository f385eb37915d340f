// SPDX-License-Identifier: BSD-3-Clause
#include "base/config/nearest_name.h"

#include <gtest/gtest.h>

namespace psi_slam {
namespace {

TEST(NearestName, counts_typing_errors) {
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("", "abc"), 3u);
  EXPECT_EQ(edit_distance("abc", ""), 3u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("widnow", "window"), 1u) << "two neighbouring letters are swapped";
  EXPECT_EQ(edit_distance("Window_M", "window_m"), 0u);
}

TEST(NearestName, finds_the_nearest_name) {
  const std::vector<std::string> names{"window_x_m", "window_y_m", "window_theta_deg"};
  EXPECT_EQ(nearest_name("windw_x_m", names), "window_x_m");
  EXPECT_EQ(nearest_name("window_z_m", names), "window_x_m") << "the first of the names with equal distance";
  EXPECT_EQ(nearest_name("windowthetadeg", names), "window_theta_deg");
}

TEST(NearestName, proposes_nothing_distant) {
  EXPECT_FALSE(nearest_name(std::string(10'000'000, 'w'), {"window_m", "windows"})) << "and is quick";
  EXPECT_EQ(nearest_name("resolution", {"window_x_m"}), std::nullopt);
  EXPECT_EQ(nearest_name("psi", {"ga", "csm"}), std::nullopt);
  EXPECT_EQ(nearest_name("x", {}), std::nullopt);
}

}  // namespace
}  // namespace psi_slam
