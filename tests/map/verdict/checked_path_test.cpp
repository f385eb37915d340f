// SPDX-License-Identifier: BSD-3-Clause
#include "map/verdict/checked_path.h"

#include <gtest/gtest.h>

namespace psi_slam {
namespace {

/// Views of one run, a metre apart along x.
std::vector<MapView> straight_views(std::size_t count) {
  std::vector<MapView> views(count);
  for (std::size_t i = 0; i < count; ++i) {
    views[i].frame = 10 * i;
    views[i].travelled_m = static_cast<double>(i);
    views[i].map_T_robot = {static_cast<double>(i), 0, 0};
  }
  return views;
}

PassCheck check_between(std::size_t view, std::size_t other, double error_m = 0) {
  PassCheck check;
  check.view = view;
  check.other = other;
  check.error_m = error_m;
  return check;
}

TEST(CheckedPath, is_held_between_views_that_fit_each_other) {
  const std::vector<MapView> views = straight_views(20);
  EXPECT_EQ(held_share({}, {}, 0.2), 0);
  EXPECT_EQ(held_share(views, {}, 0.2), 0);
  EXPECT_DOUBLE_EQ(held_share(views, {check_between(14, 5)}, 0.2), 0.5);
  EXPECT_DOUBLE_EQ(held_share(views, {check_between(14, 5), check_between(9, 6)}, 0.2), 0.5)
      << "counted once";
  EXPECT_DOUBLE_EQ(held_share(views, {check_between(14, 5), check_between(19, 16)}, 0.2), 0.7);
  EXPECT_EQ(held_share(views, {check_between(14, 5, 0.3)}, 0.2), 0) << "they do not fit";
  PassCheck successive = check_between(14, 5);
  successive.same_pass = true;
  EXPECT_EQ(held_share(views, {successive}, 0.2), 0);
}

TEST(CheckedPath, is_held_between_views_that_fit_another_run) {
  std::vector<MapView> views = straight_views(20);
  for (std::size_t i = 10; i < 20; ++i) views[i].run = 1;
  EXPECT_DOUBLE_EQ(held_share(views, {check_between(12, 4)}, 0.2), 0.1) << "a single place of each run";
  EXPECT_DOUBLE_EQ(held_share(views, {check_between(12, 4), check_between(16, 8)}, 0.2), 0.5)
      << "views 4 to 8 and 12 to 16, not those between the runs";
}

// Run 0 meets run 1 at its start and run 2 at its end. Nothing closes a cycle, so nothing checks it.
TEST(CheckedPath, is_not_held_between_views_that_fit_different_runs) {
  std::vector<MapView> views = straight_views(30);
  for (std::size_t i = 10; i < 30; ++i) views[i].run = i / 10;
  const double held = held_share(views, {check_between(12, 0), check_between(25, 9)}, 0.2);
  EXPECT_DOUBLE_EQ(held, 4.0 / 30) << "single places only";
}

TEST(CheckedPath, lists_stretches_of_unknown_uncertainty_first) {
  const std::vector<MapView> views = straight_views(8);
  std::vector<std::optional<double>> errors_m(8);
  errors_m[3] = 0.01;
  std::vector<std::optional<double>> sigmas_m(8, 0.1);
  sigmas_m[6].reset();
  const std::vector<UncheckedStretch> stretches = unchecked_stretches(views, errors_m, sigmas_m, 1);
  ASSERT_EQ(stretches.size(), 2U);
  EXPECT_EQ(stretches[0].first_frame, 40U);
  EXPECT_FALSE(stretches[0].sigma_m) << "one of its views is not placed";
}

TEST(CheckedPath, lists_the_most_uncertain_unchecked_stretch_first) {
  const std::vector<MapView> views = straight_views(12);
  std::vector<std::optional<double>> errors_m(12);
  std::vector<std::optional<double>> sigmas_m(12, 0.1);
  for (const std::size_t checked : {3U, 4U, 6U}) errors_m[checked] = 0.01;
  sigmas_m[9] = 0.4;
  const std::vector<UncheckedStretch> stretches = unchecked_stretches(views, errors_m, sigmas_m, 1);
  ASSERT_EQ(stretches.size(), 2U) << "view 5 alone is no stretch";
  EXPECT_EQ(stretches[0].first_frame, 70U);
  EXPECT_EQ(stretches[0].last_frame, 110U);
  EXPECT_EQ(stretches[0].length_m, 4);
  EXPECT_EQ(stretches[0].first_at.x, 7);
  EXPECT_EQ(stretches[0].last_at.x, 11);
  EXPECT_EQ(stretches[0].sigma_m, 0.4);
  EXPECT_EQ(stretches[1].first_frame, 0U);
  EXPECT_EQ(stretches[1].last_frame, 20U);
}

TEST(CheckedPath, divides_unchecked_stretches_at_runs) {
  std::vector<MapView> views = straight_views(10);
  for (std::size_t i = 5; i < 10; ++i) views[i].run = 1;
  const std::vector<std::optional<double>> none(10);
  const std::vector<UncheckedStretch> stretches = unchecked_stretches(views, none, none, 1);
  ASSERT_EQ(stretches.size(), 2U);
  EXPECT_EQ(stretches[0].last_frame, 40U);
  EXPECT_FALSE(stretches[0].sigma_m);
}

}  // namespace
}  // namespace psi_slam
