// SPDX-License-Identifier: BSD-3-Clause
#include "logs/doctor/quick_check.h"

#include <gmock/gmock.h>
#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "psi_slam/open_log.h"
#include "shared_logs.h"
#include "simulated_run.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<Frame> frames_of(const SimulatedRun& run) {
  std::vector<Frame> frames;
  for (std::size_t i = 0; i < run.truth.size(); ++i) {
    Frame frame;
    frame.index = i;
    frame.time_us = 1'000'000'000 + 200'000 * static_cast<TimeUs>(i);
    frame.odom_T_robot = run.odometry[i];
    frame.scan = run.scan(i);
    frames.push_back(std::move(frame));
  }
  return frames;
}

std::vector<std::string> faults_after(const std::function<void(Frame&)>& change) {
  std::vector<Frame> frames = frames_of(round_trips(2));
  for (Frame& frame : frames) change(frame);
  return quick_check(frames, 0, frames.size(), {});
}

TEST(QuickCheck, finds_nothing_in_a_sound_log) {
  EXPECT_THAT(faults_after([](Frame&) {}), IsEmpty());
}

TEST(QuickCheck, finds_a_mirrored_laser) {
  const auto faults = faults_after(
      [](Frame& frame) { std::reverse(frame.scan.ranges_m.begin(), frame.scan.ranges_m.end()); });
  EXPECT_THAT(faults, ElementsAre(HasSubstr("log.mirrored = true")));
}

TEST(QuickCheck, finds_wrong_units_of_odometry) {
  EXPECT_THAT(faults_after([](Frame& frame) {
                frame.odom_T_robot.x *= 1000;
                frame.odom_T_robot.y *= 1000;
              }),
              ElementsAre(HasSubstr("millimetres")));
}

TEST(QuickCheck, calls_headings_degrees_that_no_quaternion_has) {
  EXPECT_THAT(faults_after([](Frame& frame) { frame.odom_T_robot.phi *= 180 / M_PI; }),
              ElementsAre(HasSubstr("they look like degrees")));
  EXPECT_THAT(faults_after([](Frame& frame) {
                frame.odom_T_robot.phi = mrpt::math::wrapToPi(frame.odom_T_robot.phi * 180 / M_PI);
              }),
              ElementsAre(HasSubstr("odometry's turns are unrelated to those of the scans")));
}

TEST(QuickCheck, states_no_offset_of_clocks_of_a_laser_with_a_stated_delay) {
  std::vector<Frame> frames = frames_of(with_late_stamps(round_trips(2), 3));
  EXPECT_THAT(quick_check(frames, 0, frames.size(), {}), ElementsAre(HasSubstr("log.scan_delay_s = ")));
  LogOptions of_one_laser;  // which the frames do not name
  of_one_laser.scan_delay_s = "RLASER 2";
  EXPECT_THAT(quick_check(frames, 0, frames.size(), of_one_laser), IsEmpty());
}

TEST(QuickCheck, finds_odometry_that_measures_wrong_distances) {
  const auto faults_at = [](double scale, const LogOptions& options = {}) {
    std::vector<Frame> frames = frames_of(round_trips(2));
    for (Frame& frame : frames) {
      frame.odom_T_robot.x *= scale;
      frame.odom_T_robot.y *= scale;
    }
    return quick_check(frames, 0, frames.size(), options);
  };
  EXPECT_THAT(faults_at(1.08), ElementsAre(HasSubstr("odometry overstates distances by ")));
  EXPECT_THAT(faults_at(0.92), ElementsAre(HasSubstr("odometry understates distances by ")));
  EXPECT_THAT(faults_at(1.03), IsEmpty()) << "usual for wheels";
  LogOptions stated;  // the frames of a mapped log are corrected already
  stated.odometry_scale = 0.8;
  EXPECT_THAT(faults_at(1, stated), IsEmpty());
  EXPECT_THAT(faults_at(0.9, stated), ElementsAre(HasSubstr("log.odometry_scale = 0.8")));
}

TEST(QuickCheck, finds_a_laser_that_looks_backwards) {
  EXPECT_THAT(faults_after([](Frame& frame) { frame.scan.robot_T_laser.phi = M_PI; }),
              ElementsAre(HasSubstr("log.laser_yaw_deg = ")));
}

TEST(QuickCheck, finds_late_scans) {
  const std::vector<Frame> frames = frames_of(with_late_stamps(round_trips(2), 0.3));
  const std::vector<std::string> faults = quick_check(frames, 0, frames.size(), {});
  ASSERT_EQ(faults.size(), 1U);
  EXPECT_THAT(faults[0], HasSubstr("turns show that the scans are stamped 0."));
  EXPECT_THAT(faults[0], HasSubstr("s later than odometry"));
  LogOptions corrected;  // the frames of a mapped log are corrected already
  corrected.scan_delay_s = "0.3";
  const std::vector<Frame> sound = frames_of(round_trips(2));
  EXPECT_THAT(quick_check(sound, 0, sound.size(), corrected), IsEmpty());
}

TEST(QuickCheck, finds_few_returns) {
  EXPECT_THAT(faults_after([](Frame& frame) {
                for (float& range : frame.scan.ranges_m)
                  if (range > 1) range = std::numeric_limits<float>::infinity();
              }),
              testing::Contains(HasSubstr("log.max_range_m")));
}

TEST(QuickCheck, finds_a_jump_of_the_clock) {
  const auto set_clock = [](TimeUs by_us) {
    return faults_after([by_us](Frame& frame) {
      if (frame.index >= 50) frame.time_us += by_us;
    });
  };
  EXPECT_THAT(set_clock(-5'000'000),
              ElementsAre(HasSubstr("the clock jumps by -4.8 s, 9.80 s into the log")));
  EXPECT_THAT(set_clock(60'000'000), ElementsAre(HasSubstr("the clock jumps by 60.2 s")));
}

TEST(QuickCheck, needs_no_odometry_and_no_scan) {
  EXPECT_THAT(faults_after([](Frame& frame) { frame.has_odometry = false; }), IsEmpty());
  EXPECT_THAT(quick_check({}, 0, 0, {}), IsEmpty());
}

class QuickCheckOfRealLogs : public testing::TestWithParam<const char*> {};

TEST_P(QuickCheckOfRealLogs, finds_nothing_but_late_scans) {
  const auto path = shared_file(std::string(GetParam()) + ".clf.gz");
  if (!path) GTEST_SKIP() << kNeedsData;
  std::vector<Frame> frames;
  const auto log = open_log(*path, {});
  while (auto frame = log->next()) frames.push_back(*std::move(frame));
  const std::vector<std::string> faults = quick_check(frames, 0, frames.size(), {});
  const std::string name = GetParam();
  if (name == "aces" || name == "intel")
    EXPECT_THAT(faults, IsEmpty());
  else
    EXPECT_THAT(faults, ElementsAre(HasSubstr("s later than odometry")));
}

INSTANTIATE_TEST_SUITE_P(Logs, QuickCheckOfRealLogs,
                         testing::Values("aces", "fr079", "intel", "mit-csail", "mit-killian"),
                         [](const auto& tested) {
                           std::string name = tested.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace psi_slam
