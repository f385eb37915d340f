// SPDX-License-Identifier: BSD-3-Clause
// Maps a real log, and then localizes the robot in the finished map while it drives the log again and again.
// After each round, somebody carries the robot back to the start.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "allocated_memory.h"
#include "psi_slam/grid_map.h"
#include "psi_slam/localizer.h"
#include "psi_slam/mapping_session.h"
#include "sanitizer.h"
#include "session/settings.h"
#include "shared_logs.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using State = LocalizationStep::State;

constexpr TimeUs kCarried_us = 10'000'000;  // time between rounds

/// Returns the number of rounds: those in the hours of the variable PSI_SLAM_SOAK_HOURS, or a few.
std::size_t number_of_rounds(double round_s) {
  constexpr std::size_t kFew = 3;
  const char* const hours = std::getenv("PSI_SLAM_SOAK_HOURS");
  return hours == nullptr ? kFew
                          : std::max(kFew, static_cast<std::size_t>(std::stod(hours) * 3600 / round_s));
}

/// Sums over all rounds.
struct Figures {
  std::size_t scans = 0;
  std::size_t tracked = 0;
  std::size_t wrong = 0;           ///< poses farther than 0.5 m from those of the map
  std::vector<double> memory_MiB;  ///< after each round
  std::size_t tracked_at_end = 0;  ///< rounds at whose end the robot is tracked
};

/// Drives the log once more. `odom_T_start` is the pose of the first scan in the odometry of all rounds.
void drive(const MappingResult& mapped, TimeUs later_us, const TPose2D& odom_T_start, Localizer& localizer,
           Figures& figures) {
  constexpr double kWrong_m = 0.5;
  const TPose2D start_T_odom = odom_T_start + (TPose2D() - mapped.log.front().odom_T_robot);
  State state = State::kLost;
  for (std::size_t i = 0; i < mapped.log.size(); ++i) {
    Frame frame = mapped.log[i];
    frame.index = figures.scans++;
    frame.time_us += later_us;
    frame.odom_T_robot = start_T_odom + frame.odom_T_robot;
    const LocalizationStep step = localizer.add(frame);
    state = step.state;
    if (state != State::kTracking) continue;
    ++figures.tracked;
    const TPose2D& there = mapped.frames[i].map_T_robot;
    if (std::hypot(step.map_T_robot.x - there.x, step.map_T_robot.y - there.y) > kWrong_m) ++figures.wrong;
  }
  if (state == State::kTracking) ++figures.tracked_at_end;
  figures.memory_MiB.push_back(allocated_MiB());
}

TEST(LocalizeForHours, keeps_the_memory_and_finds_the_robot_again_and_again) {
  if (kHasAddressSanitizer || kHasThreadSanitizer)
    GTEST_SKIP() << "sanitizers have their own memory allocation";
  const auto log = shared_file("mit-csail.clf.gz");
  if (!log) GTEST_SKIP() << kNeedsData;
  BoundSettings bound;
  bound.load(std::string(PSI_SLAM_INI_FOLDER) + "/mit-csail.ini", {});
  MappingSession session(*log, bound.settings);
  while (session.step()) {
  }
  session.finish();
  const MappingResult& mapped = session.result();
  std::vector<TPose2D> map_T_robot;
  for (const FrameRecord& record : mapped.frames) map_T_robot.push_back(record.map_T_robot);
  Localizer localizer(*draw_grid_map(mapped.log, map_T_robot, bound.settings.map),
                      localizer_options(bound.settings));

  const TimeUs round_us = mapped.log.back().time_us - mapped.log.front().time_us + kCarried_us;
  const std::size_t rounds = number_of_rounds(seconds(round_us));
  Figures figures;
  TPose2D odom_T_start;
  const auto begin = std::chrono::steady_clock::now();
  for (std::size_t round = 0; round < rounds; ++round) {
    drive(mapped, static_cast<TimeUs>(round) * round_us, odom_T_start, localizer, figures);
    // Odometry does not measure how the robot is carried.
    odom_T_start = odom_T_start + (mapped.log.back().odom_T_robot - mapped.log.front().odom_T_robot);
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  const double share = static_cast<double>(figures.tracked) / static_cast<double>(figures.scans);
  std::printf(
      "%zu rounds, %.1f h of log time, %.0f times as fast as real time; %.1f %% of the scans tracked, %zu "
      "farther than 0.5 m from the map's path; memory after the first round %.1f MiB, after half of them "
      "%.1f, after the last %.1f\n",
      rounds, static_cast<double>(rounds) * seconds(round_us) / 3600,
      static_cast<double>(rounds) * seconds(round_us) / took.count(), 100 * share, figures.wrong,
      figures.memory_MiB.front(), figures.memory_MiB[rounds / 2], figures.memory_MiB.back());
  EXPECT_EQ(figures.tracked_at_end, rounds);
  EXPECT_GT(share, 0.8);
  EXPECT_LT(static_cast<double>(figures.wrong), 0.01 * static_cast<double>(figures.scans));
  constexpr double kGrowth_MiB = 1;
  EXPECT_LT(figures.memory_MiB.back(), figures.memory_MiB.front() + kGrowth_MiB);
}

}  // namespace
}  // namespace psi_slam
