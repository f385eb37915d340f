// SPDX-License-Identifier: BSD-3-Clause
#include "matching/search_window.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

namespace psi_slam {
namespace {

using testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(SearchWindow, equations_7_and_8_by_hand) {
  // A turn by 60 degrees moves a point at a distance of one cell by one cell (equilateral triangle).
  const SearchWindow window = make_search_window({8.0, 2.5, M_PI}, 1.0, 1.0);
  EXPECT_DOUBLE_EQ(window.linear_step_m, 1.0);
  EXPECT_NEAR(window.angular_step_rad, M_PI / 3, 1e-12);
  EXPECT_EQ(window.n_x, 8);
  EXPECT_EQ(window.n_y, 3);
  EXPECT_EQ(window.n_theta, 3);
}

TEST(SearchWindow, the_window_of_the_paper) {
  const SearchWindow window = make_search_window({8.0, 8.0, M_PI / 6}, 0.05, 20.0);
  EXPECT_EQ(window.n_x, 160);
  EXPECT_EQ(window.n_y, 160);
  EXPECT_NEAR(window.angular_step_rad, 0.0025, 1e-8);
  EXPECT_EQ(window.n_theta, 210);  // 0.5236 / 0.0025 = 209.4
}

TEST(SearchWindow, one_turn_moves_the_farthest_point_by_one_cell) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> resolution(0.01, 0.2);
  std::uniform_real_distribution<double> distance(0.2, 80.0);
  for (int i = 0; i < 1000; ++i) {
    const double r = resolution(random);
    const double d = distance(random);
    const SearchWindow window = make_search_window({1, 1, 1}, r, d);
    const double chord = 2 * d * std::sin(window.angular_step_rad / 2);
    EXPECT_NEAR(chord, r, 1e-6 * r) << "resolution " << r << ", distance " << d;
  }
}

TEST(SearchWindow, steps_cover_the_extent_and_are_no_more_than_needed) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> width(0.001, 10.0);
  std::uniform_real_distribution<double> angle(0.001, M_PI);
  for (int i = 0; i < 1000; ++i) {
    const SearchExtent extent = {width(random), width(random), angle(random)};
    const SearchWindow window = make_search_window(extent, 0.05, width(random) + 0.1);
    const auto covers = [](int n, double step, double half_width) {
      return n * step >= half_width - 1e-8 * step && (n - 1) * step < half_width;
    };
    EXPECT_TRUE(covers(window.n_x, window.linear_step_m, extent.x_m)) << extent.x_m;
    EXPECT_TRUE(covers(window.n_y, window.linear_step_m, extent.y_m)) << extent.y_m;
    EXPECT_TRUE(covers(window.n_theta, window.angular_step_rad, extent.theta_rad)) << extent.theta_rad;
  }
}

TEST(SearchWindow, a_whole_number_of_cells_stays_whole) {
  for (int cells = 1; cells <= 1000; ++cells)
    for (const double resolution_m : {0.05, 0.1, 0.025, 0.03})
      EXPECT_EQ(make_search_window({cells * resolution_m, 1, 1}, resolution_m, 10.0).n_x, cells)
          << cells << " cells of " << resolution_m;
}

TEST(SearchWindow, a_degenerate_window_is_an_error_that_names_the_values) {
  const struct {
    SearchExtent extent;
    double resolution_m;
    double farthest_m;
    const char* named;
  } cases[] = {
      {{0, 1.5, 1}, 0.05, 10, "half-widths 0 m, 1.5 m"},
      {{1, -2.5, 1}, 0.05, 10, "-2.5 m"},
      {{1, 1, 0}, 0.05, 10, "0 rad"},
      {{kNan, 1, 1}, 0.05, 10, "nan m"},
      {{kInfinity, 1, 1}, 0.05, 10, "inf m"},
      {{1, kInfinity, 1}, 0.05, 10, "inf m"},
      {{1, 1, kInfinity}, 0.05, 10, "inf rad"},
      {{1, 1, 1}, 0, 10, "resolution 0 m"},
      {{1, 1, 1}, -0.05, 10, "resolution -0.05 m"},
      {{1, 1, 1}, kInfinity, 10, "resolution inf m"},
      {{1, 1, 1}, 0.05, 0, "farthest point 0 m"},
      {{1, 1, 1}, 0.05, 0.025, "farthest point 0.025 m"},
      {{1, 1, 1}, 0.05, kNan, "farthest point nan m"},
      {{1, 1, 1}, 0.05, kInfinity, "farthest point inf m"},
  };
  for (const auto& c : cases) {
    try {
      make_search_window(c.extent, c.resolution_m, c.farthest_m);
      ADD_FAILURE() << "no exception, expected one that names " << c.named;
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), HasSubstr(c.named));
    }
  }
}

TEST(SearchWindow, a_window_of_more_steps_than_can_be_counted_is_an_error) {
  EXPECT_THROW(make_search_window({1e12, 1, 1}, 0.05, 10), std::invalid_argument);
  EXPECT_THROW(make_search_window({1, 1, 1}, 0.05, 1e30), std::invalid_argument);
}

}  // namespace
}  // namespace psi_slam
