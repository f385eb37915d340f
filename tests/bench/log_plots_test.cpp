// SPDX-License-Identifier: BSD-3-Clause
#include "common/log_plots.h"

#include <gmock/gmock.h>

#include <regex>

#include "well_formed.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;

std::vector<double> bar_widths(const std::string& svg) {
  static const std::regex kBar("<rect x=\"[0-9.]+\" y=\"[0-9.]+\" width=\"(-?[0-9.]+)\"");
  std::vector<double> widths;
  for (std::sregex_iterator bar(svg.begin(), svg.end(), kBar), end; bar != end; ++bar)
    widths.push_back(std::stod((*bar)[1]));
  return widths;
}

TEST(BarPlot, a_factor_is_the_same_length_everywhere) {
  const std::string svg = bar_svg({"Errors", "m", {{"a < b & c", 0.02, true}, {"b", 0.2}, {"c", 2}}});
  EXPECT_EQ(complaint_about(svg), "");
  EXPECT_THAT(svg, HasSubstr("a &lt; b &amp; c"));
  const std::vector<double> widths = bar_widths(svg);
  ASSERT_EQ(widths.size(), 3U);
  EXPECT_GT(widths[0], 0);
  EXPECT_NEAR(widths[2] - widths[1], widths[1] - widths[0], 0.2);
}

TEST(BarPlot, accepts_equal_values_zeros_and_no_bars) {
  EXPECT_THAT(bar_widths(bar_svg({"", "m", {{"a", 1}, {"b", 1}}})), testing::Each(testing::Gt(0)));
  EXPECT_THAT(bar_widths(bar_svg({"", "m", {{"a", 0}}})), testing::ElementsAre(0));
  EXPECT_EQ(complaint_about(bar_svg({"", "m", {}})), "");
}

}  // namespace
}  // namespace psi_slam
