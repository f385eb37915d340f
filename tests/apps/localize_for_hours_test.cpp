// SPDX-License-Identifier: BSD-3-Clause
// Maps a real log, and then localizes the robot in the finished map while the log is replayed again and
// again. The thirds of the log follow in another order, so the robot is carried away after each of them.
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
#include "logs/frames/discarded_ranges.h"
#include "logs/frames/pose_operations.h"
#include "map/exports/mapped_trajectory.h"
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

constexpr TimeUs kCarried_us = 10'000'000;  // time in which the robot is carried

/// Returns the number of rounds: those in the hours of the variable PSI_SLAM_SOAK_HOURS, or a few.
std::size_t number_of_rounds(double round_s) {
  constexpr std::size_t kFew = 3;
  const char* const hours = std::getenv("PSI_SLAM_SOAK_HOURS");
  return hours == nullptr ? kFew
                          : std::max(kFew, static_cast<std::size_t>(std::stod(hours) * 3600 / round_s));
}

/// Sums over all rounds.
struct HoursOfTracking {
  std::size_t scans = 0;
  std::size_t tracked = 0;
  std::size_t wrong = 0;           ///< fitting poses farther than 0.5 m from those of the map
  std::size_t carries = 0;         ///< replayed thirds, which each begin elsewhere
  std::size_t noticed = 0;         ///< of these, how often the robot counted as lost
  std::size_t found = 0;           ///< and how often it was tracked in the end
  std::vector<double> memory_MiB;  ///< after each round
};

/// A robot whose odometry does not measure how it is carried.
class CarriedRobot {
 public:
  CarriedRobot(const MappingResult& mapped, Localizer& localizer) : mapped_(mapped), localizer_(localizer) {}

  /// Replays the scans [begin, end) of the log. Times continue from those before.
  void replay(std::size_t begin, std::size_t end, HoursOfTracking& figures) {
    constexpr double kWrong_m = 0.5;
    const Frame& first = mapped_.log[begin];
    const TPose2D odom_T_log_odom = compose(odom_T_robot_, inverse(first.odom_T_robot));
    const TimeUs later_us = time_us_ + kCarried_us - first.time_us;
    bool noticed = false;
    State state = State::kLost;
    for (std::size_t i = begin; i < end; ++i) {
      Frame frame = mapped_.log[i];
      ASSERT_TRUE(has_ranges(frame)) << "discarded by the mapper";
      frame.index = figures.scans++;
      time_us_ = frame.time_us += later_us;
      odom_T_robot_ = frame.odom_T_robot = compose(odom_T_log_odom, frame.odom_T_robot);
      const LocalizationStep step = localizer_.add(frame);
      state = step.state;
      noticed = noticed || state == State::kLost;
      if (state != State::kTracking) continue;
      ++figures.tracked;
      const TPose2D off = between(step.map_T_robot, mapped_.frames[i].map_T_robot);
      if (step.fits && std::hypot(off.x, off.y) > kWrong_m) ++figures.wrong;
    }
    ++figures.carries;
    if (noticed) ++figures.noticed;
    if (state == State::kTracking) ++figures.found;
  }

 private:
  const MappingResult& mapped_;
  Localizer& localizer_;
  TimeUs time_us_ = 0;
  TPose2D odom_T_robot_;
};

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
  Localizer localizer(*draw_grid_map(mapped.log, mapped_poses(mapped), bound.settings.map),
                      localizer_options(bound.settings));

  const std::size_t scans = mapped.log.size();
  const double round_s = seconds(mapped.log.back().time_us - mapped.log.front().time_us + 3 * kCarried_us);
  const std::size_t rounds = number_of_rounds(round_s);
  HoursOfTracking figures;
  CarriedRobot robot(mapped, localizer);
  const auto begin = std::chrono::steady_clock::now();
  for (std::size_t round = 0; round < rounds; ++round) {
    for (const std::size_t third : {0U, 2U, 1U})
      robot.replay(third * scans / 3, (third + 1) * scans / 3, figures);
    figures.memory_MiB.push_back(allocated_MiB());
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  const double share = static_cast<double>(figures.tracked) / static_cast<double>(figures.scans);
  const double log_time_s = static_cast<double>(rounds) * round_s;
  std::printf(
      "%zu rounds, %.1f h of log time, %.0f times as fast as real time; carried %zu times, noticed %zu, "
      "found again %zu; %.1f %% of the scans tracked, %zu farther than 0.5 m from the map's path; memory "
      "after the first round %.1f MiB, after half of them %.1f, after the last %.1f\n",
      rounds, log_time_s / 3600, log_time_s / took.count(), figures.carries, figures.noticed, figures.found,
      100 * share, figures.wrong, figures.memory_MiB.front(), figures.memory_MiB[rounds / 2],
      figures.memory_MiB.back());
  EXPECT_EQ(figures.noticed, figures.carries);
  EXPECT_EQ(figures.found, figures.carries);
  EXPECT_GT(share, 0.7);
  EXPECT_LT(static_cast<double>(figures.wrong), 0.01 * static_cast<double>(figures.scans));
  constexpr double kGrowth_MiB = 0.3;
  EXPECT_LT(figures.memory_MiB.back(), figures.memory_MiB.front() + kGrowth_MiB);
}

}  // namespace
}  // namespace psi_slam
