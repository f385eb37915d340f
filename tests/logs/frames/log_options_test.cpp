// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/log_options.h"

#include <limits>

#include "log_files.h"

namespace psi_slam {
namespace {

std::string sentence_about(const LogOptions& options) {
  return sentence_of([&] { check_log_options(options); });
}

TEST(LogOptions, defaults_are_valid) {
  EXPECT_NO_THROW(check_log_options(LogOptions{}));
}

TEST(LogOptions, invalid_values_are_reported_by_name_and_value) {
  LogOptions options;
  options.every_nth_scan = 0;
  EXPECT_EQ(sentence_about(options), "log.every_nth_scan is 0, expected 1 or more");

  options = {};
  options.field_of_view_rad = 0;
  EXPECT_EQ(sentence_about(options),
            "log.field_of_view_deg is 0, expected more than 0 and up to 360 degrees");
  options.field_of_view_rad = 6.4;
  EXPECT_THROW(check_log_options(options), UserError);
  options.field_of_view_rad = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(check_log_options(options), UserError);

  options = {};
  options.min_range_m = -0.5;
  EXPECT_EQ(sentence_about(options), "log.min_range_m is -0.5, expected 0 metres or more");

  options = {};
  options.min_range_m = 2;
  options.max_range_m = 1.5;
  EXPECT_EQ(sentence_about(options), "log.max_range_m is 1.5, expected more metres than log.min_range_m");

  options = {};
  options.odometry_scale = 0;
  EXPECT_EQ(sentence_about(options), "log.odometry_scale is 0, expected 0.01 to 100");
  options = {};
  for (const char* wrong : {"-600.5", "late", "0.1, 0.2", "A 0.1, A 0.2", "A 0.1, 0.2", "A 0.1,", "A"}) {
    options.scan_delay_s = wrong;
    EXPECT_EQ(
        sentence_about(options),
        std::string("log.scan_delay_s is \"") + wrong +
            "\", expected auto, -600 to 600 seconds, or a laser's name and its seconds such as \"RLASER "
            "0.1\". Separate several lasers by commas, and name each one once");
  }

  options = {};
  options.robot_T_laser = mrpt::math::TPose2D{0, std::numeric_limits<double>::infinity(), 0};
  EXPECT_THROW(check_log_options(options), UserError);
}

}  // namespace
}  // namespace psi_slam
