// SPDX-License-Identifier: BSD-3-Clause
#include "matching/pose_code.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>
#include <stdexcept>
#include <tuple>

#include "score_grids.h"

namespace psi_slam {
namespace {

const std::vector<SearchWindow>& windows() {
  static const std::vector<SearchWindow> all = {
      window_of_steps(1, 1, 1, 0.05), window_of_steps(4, 4, 2, 0.05), window_of_steps(7, 3, 5, 0.01),
      window_of_steps(16, 8, 9, 0.01), window_of_steps(3, 11, 16, 0.01)};
  return all;
}

TEST(PoseCode, every_pose_of_the_window_has_a_unique_code_that_decodes_to_it) {
  for (const SearchWindow& window : windows()) {
    const PoseCode code(window);
    std::set<Chromosome> codes;
    for (int theta = -window.n_theta; theta < window.n_theta; ++theta) {
      for (int y = -window.n_y; y < window.n_y; ++y) {
        for (int x = -window.n_x; x < window.n_x; ++x) {
          const Chromosome chromosome = code.encode({x, y, theta});
          EXPECT_TRUE(codes.insert(chromosome).second);
          const LatticePose back = code.decode(chromosome);
          ASSERT_EQ(std::tie(back.x, back.y, back.theta), std::tie(x, y, theta));
        }
      }
    }
    EXPECT_EQ(codes.size(), 8U * window.n_x * window.n_y * window.n_theta) << "2 n codes on each axis";
  }
}

// Decodes all strings of bits, including codes outside the window.
TEST(PoseCode, every_code_is_a_pose_of_the_window) {
  for (const SearchWindow& window : windows()) {
    const PoseCode code(window);
    ASSERT_LE(code.bits(), 20);
    std::size_t inside = 0;
    for (Chromosome chromosome = 0; chromosome < (Chromosome{1} << code.bits()); ++chromosome) {
      const LatticePose pose = code.decode(chromosome);
      ASSERT_TRUE(-window.n_x <= pose.x && pose.x < window.n_x);
      ASSERT_TRUE(-window.n_y <= pose.y && pose.y < window.n_y);
      ASSERT_TRUE(-window.n_theta <= pose.theta && pose.theta < window.n_theta);
      if (code.encode(pose) == chromosome) ++inside;
    }
    EXPECT_EQ(inside, 8U * window.n_x * window.n_y * window.n_theta);
  }
}

TEST(PoseCode, lengths_are_the_smallest_of_equation_10) {
  for (const SearchWindow& window : windows()) {
    const PoseCode code(window);
    const double l_max = 4.0 * window.n_x * window.n_y;
    const double r_max = 2.0 * window.n_theta;
    EXPECT_GT(std::pow(2, code.position_bits()), l_max);
    EXPECT_LE(std::pow(2, code.position_bits() - 1), l_max);
    EXPECT_GT(std::pow(2, code.angle_bits()), r_max);
    EXPECT_LE(std::pow(2, code.angle_bits() - 1), r_max);
  }
}

// The window of the paper, computed by hand. r_t = 5 cm and W = 8 m give n = 160.
// L_max = 320^2 = 102,400 is less than 2^17.
TEST(PoseCode, the_window_of_the_paper_takes_17_bits_for_positions) {
  const PoseCode code(window_of_steps(160, 160, 184, 0.003));
  EXPECT_EQ(code.position_bits(), 17);
  EXPECT_EQ(code.angle_bits(), 9);
  EXPECT_EQ(code.bits(), 26);
}

// Expected codes are computed by hand from equations 9 and 12.
TEST(PoseCode, bits_are_least_significant_first_position_before_angle) {
  const PoseCode code(window_of_steps(4, 4, 2, 0.05));  // 8 x 8 cells: 7 bits; 4 angles: 3 bits
  EXPECT_EQ(code.encode({-4, -4, -2}), 0U);
  EXPECT_EQ(code.encode({-3, -4, -2}), 1U) << "next column";
  EXPECT_EQ(code.encode({-4, -3, -2}), 8U) << "next row";
  EXPECT_EQ(code.encode({-4, -4, -1}), 1U << 7) << "next angle";
  EXPECT_EQ(code.encode({3, 3, 1}), 63U + (3U << 7));
}

TEST(PoseCode, codes_outside_are_repaired_by_the_modulus) {
  const PoseCode code(window_of_steps(4, 4, 2, 0.05));
  const LatticePose position = code.decode(64 + 5);
  EXPECT_EQ(code.encode(position), 5U);
  EXPECT_EQ(code.decode(6U << 7).theta, 0) << "6 modulo 4 is 2, the third angle";
}

TEST(PoseCode, refuses_windows_without_cells_and_codes_of_more_than_64_bits) {
  EXPECT_THROW(PoseCode(window_of_steps(0, 4, 4, 0.05)), std::invalid_argument);
  EXPECT_THROW(PoseCode(window_of_steps(4, 4, -1, 0.05)), std::invalid_argument);
  EXPECT_NO_THROW(PoseCode(window_of_steps(1'000'000, 1'000'000, 1'000'000, 1e-6)));
  EXPECT_THROW(PoseCode(window_of_steps(1'000'000'000, 1'000'000'000, 1'000'000, 1e-6)),
               std::invalid_argument);
}

}  // namespace
}  // namespace psi_slam
