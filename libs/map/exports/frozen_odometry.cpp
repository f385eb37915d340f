// SPDX-License-Identifier: BSD-3-Clause
#include "map/exports/frozen_odometry.h"

#include <cmath>

#include "base/degrees.h"
#include "base/number_text.h"
#include "logs/frames/pose_operations.h"
#include "mapping/scan_place.h"

namespace psi_slam {
namespace {

constexpr double kLeastDuration_s = 2;  // odometry that is silent for less may come late
constexpr double kLeastMotion_m = 0.5;
constexpr double kLeastTurn_rad = radians_from_degrees(30.0L);

// A stretch of scans with the same odometry. The last scan is included.
struct Stretch {
  std::size_t first = 0;
  std::size_t last = 0;
  double path_m = 0;
  double turn_rad = 0;
  bool has_moved = false;  // away from the place of the first scan
};

void append(Stretch& stretch, const std::vector<FrameRecord>& frames) {
  const auto& last = frames[stretch.last].front_end_T_robot;
  const auto& next = frames[++stretch.last].front_end_T_robot;
  stretch.path_m += distance_m(last, next);
  stretch.turn_rad += std::abs(between(last, next).phi);
  const auto& first = frames[stretch.first].front_end_T_robot;
  stretch.has_moved = stretch.has_moved || distance_m(first, next) >= kLeastMotion_m ||
                      std::abs(between(first, next).phi) >= kLeastTurn_rad;
}

}  // namespace

std::optional<std::string> frozen_odometry_text(const MappingResult& result) {
  const std::vector<FrameRecord>& frames = result.frames;
  std::size_t scans = 0;
  Stretch longest;
  for (const FrameSpan& run : runs_of(result)) {
    for (std::size_t begin = run.begin; begin < run.end;) {
      Stretch stretch{begin, begin};
      while (stretch.last + 1 < run.end && result.log[stretch.last].has_odometry &&
             result.log[stretch.last + 1].has_odometry &&
             frames[stretch.last + 1].odom_T_robot == frames[begin].odom_T_robot)
        append(stretch, frames);
      begin = stretch.last + 1;
      const TimeUs lasts_us = frames[stretch.last].time_us - frames[stretch.first].time_us;
      if (!stretch.has_moved || seconds(lasts_us) < kLeastDuration_s) continue;
      scans += stretch.last - stretch.first;
      if (stretch.path_m + stretch.turn_rad > longest.path_m + longest.turn_rad) longest = stretch;
    }
  }
  if (scans == 0) return std::nullopt;
  const auto time = [&](std::size_t frame) {
    return minutes_text(std::floor(time_in_run_s(frames, result.later_run_frames, frame)));
  };
  return "odometry did not change in " + counted(scans, "scan") + " although the robot moved, most from " +
         time(longest.first) + " to " + time(longest.last) + ": " + fixed_text(longest.path_m, 1) +
         " m and " + fixed_text(longest.turn_rad * 180 / M_PI, 0) +
         " degrees. The scans alone determined its motion there. Check the wheel encoders and their driver";
}

}  // namespace psi_slam
