// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/gyroscope_choice.h"

#include "logs/frames/laser_choice.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

bool ignores_gyroscope(const LogOptions& options) {
  return options.imu == "none";
}

bool names_gyroscope(const LogOptions& options) {
  return !options.imu.empty() && options.imu != "auto" && !ignores_gyroscope(options);
}

GyroscopeChoice choose_gyroscope(const LogOptions& options, const std::vector<std::string>& gyroscopes,
                                 bool has_odometry, const std::string& expected) {
  const bool is_named = names_gyroscope(options);
  if (is_named && !contains(gyroscopes, options.imu))
    throw UserError("log.imu is \"" + options.imu + "\", expected " + expected + ": " +
                    (gyroscopes.empty() ? "it has none. Map without a gyroscope with log.imu=none"
                                        : quoted_list(gyroscopes)));
  GyroscopeChoice choice;
  if (has_odometry) {
    if (is_named)
      choice.assumption = "the gyroscope of \"" + options.imu +
                          "\" is not used, because the log has odometry. Ignore the odometry with "
                          "log.odometry=none";
  } else if (is_named) {
    choice.name = options.imu;
  } else if (gyroscopes.size() == 1 && !ignores_gyroscope(options)) {
    choice.name = gyroscopes.front();
  } else if (gyroscopes.size() > 1 && !ignores_gyroscope(options)) {
    choice.assumption =
        "no gyroscope predicts the heading, because the log has several: " + quoted_list(gyroscopes) +
        ". Choose one with log.imu";
  }
  return choice;
}

}  // namespace psi_slam
