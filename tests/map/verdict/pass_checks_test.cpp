// SPDX-License-Identifier: BSD-3-Clause
#include "map/verdict/pass_checks.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "two_passes.h"

namespace psi_slam {
namespace {

/// Median of the errors between the passes.
double median_error_m(const MappingResult& result) {
  const std::vector<MapView> views = map_views(result);
  std::vector<double> errors_m;
  for (const PassCheck& check : check_passes(views))
    if (!check.same_pass) errors_m.push_back(check.error_m);
  EXPECT_GT(errors_m.size(), 10U);
  std::sort(errors_m.begin(), errors_m.end());
  return errors_m[errors_m.size() / 2];
}

TEST(PassChecks, measure_the_displacement_of_the_second_pass) {
  EXPECT_LT(median_error_m(two_passes()), 0.02);
  EXPECT_NEAR(median_error_m(two_passes({0.3, 0, 0})), 0.3, 0.06);
}

TEST(PassChecks, know_nothing_about_views_that_only_one_pass_saw) {
  MappingResult result = two_passes();
  result.frames.resize(kScansPerRound / 2);
  result.log.resize(kScansPerRound / 2);
  result.node_frames.resize(kScansPerRound / 2);
  const std::vector<MapView> views = map_views(result);
  for (const std::optional<double>& error_m : errors_of_views(views.size(), check_passes(views)))
    EXPECT_FALSE(error_m);
}

TEST(PassChecks, compare_with_the_first_passes_of_a_place) {
  const MappingResult result = two_passes();
  const std::vector<MapView> once = map_views(result);
  std::vector<MapView> often;
  for (std::size_t run = 0; run < 20; ++run)
    for (MapView view : once) {
      view.run = run;
      often.push_back(view);
    }
  std::size_t compared = 0;
  for (const PassCheck& check : check_passes(often)) {
    if (check.same_pass) continue;
    EXPECT_LT(often[check.other].run, 8U) << "the work must not grow with the square of the passes";
    compared += often[check.view].run == 19 ? 1 : 0;
  }
  EXPECT_GT(compared, once.size()) << "the last pass is compared, too";
}

}  // namespace
}  // namespace psi_slam
