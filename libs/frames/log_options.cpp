// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/log_options.h"

#include <mrpt/core/bits_math.h>

#include <cmath>
#include <sstream>

#include "frames/laser_choice.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

template <class Value>
[[noreturn]] void fail(const char* key, Value value, const char* expected) {
  std::ostringstream sentence;
  sentence << key << " is " << value << ", expected " << expected;
  throw UserError(sentence.str());
}

}  // namespace

void check_log_options(const LogOptions& options) {
  if (options.every_nth_scan < 1) fail("log.every_nth_scan", options.every_nth_scan, "1 or more");
  if (options.field_of_view_rad &&
      !(*options.field_of_view_rad > 0 && *options.field_of_view_rad <= 2 * M_PI)) {
    fail("log.field_of_view_deg", mrpt::RAD2DEG(*options.field_of_view_rad),
         "more than 0 and up to 360 degrees");
  }
  if (!(options.min_range_m >= 0)) fail("log.min_range_m", options.min_range_m, "0 metres or more");
  if (options.max_range_m && !(*options.max_range_m > options.min_range_m))
    fail("log.max_range_m", *options.max_range_m, "more metres than log.min_range_m");
  if (options.sweep_time_s && !(*options.sweep_time_s >= 0 && *options.sweep_time_s <= 1))
    fail("log.sweep_time_s", *options.sweep_time_s, "0 to 1 seconds");
  if (options.robot_T_laser &&
      !(std::isfinite(options.robot_T_laser->x) && std::isfinite(options.robot_T_laser->y) &&
        std::isfinite(options.robot_T_laser->phi)))
    fail("the laser's pose on the robot", options.robot_T_laser->asString(), "finite numbers");
  stated_mounts(options);
  laser_choice("log.laser", options.laser);
  laser_choice("log.scan_topic", options.scan_topic);
}

}  // namespace psi_slam
