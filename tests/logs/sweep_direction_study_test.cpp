// SPDX-License-Identifier: BSD-3-Clause
#include "logs/sweep_direction_study.h"

#include <gmock/gmock.h>

#include <cmath>
#include <utility>

#include "frames_in_memory.h"
#include "log_files.h"
#include "logs/frames/deskewed_source.h"
#include "logs/frames/log_reader.h"
#include "logs/frames/pose_operations.h"
#include "shared_logs.h"
#include "simulated_run.h"
#include "swinging_robot.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using testing::HasSubstr;
using testing::IsEmpty;

SweepDirectionStudy study(std::vector<Frame> frames, std::optional<double> sweep_time_s = {}) {
  FramesInMemory log(std::move(frames));
  return study_sweep_directions(log, sweep_time_s).at(0);
}

/// The inverse of deskewed(): the scan that the robot measures while it moves by `motion`.
LaserScan bent(LaserScan scan, const TPose2D& motion) {
  std::vector<float> bearings = *scan.bearings_rad;
  const std::size_t last = bearings.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    const double share =
        static_cast<double>(scan.sweep_time_s < 0 ? last - i : i) / static_cast<double>(last);
    const TPose2D moved = interpolate({0, 0, 0}, motion, share);
    const TPose2D laser_T_first = inverse(inverse(scan.robot_T_laser) + moved + scan.robot_T_laser);
    const auto bearing = static_cast<double>(bearings[i]);
    if (!std::isfinite(scan.ranges_m[i])) continue;
    const auto range = static_cast<double>(scan.ranges_m[i]);
    const TPose2D point = laser_T_first + TPose2D{range * std::cos(bearing), range * std::sin(bearing), 0};
    scan.ranges_m[i] = static_cast<float>(std::hypot(point.x, point.y));
    bearings[i] = static_cast<float>(bearing + mrpt::math::wrapToPi(std::atan2(point.y, point.x) - bearing));
  }
  scan.bearings_rad = std::make_shared<const std::vector<float>>(std::move(bearings));
  return scan;
}

/// Odometry at a time between the times of frames `from` and the last frame, interpolated.
TPose2D odometry_at(const std::vector<Frame>& frames, std::size_t from, double since_s) {
  const auto time_us = frames[from].time_us + static_cast<TimeUs>(1e6 * since_s);
  std::size_t next = from + 1;
  while (next + 1 < frames.size() && frames[next].time_us < time_us) ++next;
  const Frame& before = frames[next - 1];
  const double period_s = seconds(frames[next].time_us - before.time_us);
  const double share = period_s > 0 ? seconds(time_us - before.time_us) / period_s : 0;
  return interpolate(before.odom_T_robot, frames[next].odom_T_robot, std::min(share, 1.0));
}

/// Bends all scans of a log by odometry's motion during `sweep_s`; negative: the last beam is measured first.
/// The scans state the positive sweep time.
std::vector<Frame> bent(std::vector<Frame> frames, double sweep_s) {
  for (std::size_t i = 0; i + 1 < frames.size(); ++i) {
    LaserScan& scan = frames[i].scan;
    scan.sweep_time_s = static_cast<float>(sweep_s);
    scan = bent(scan, odometry_at(frames, i, std::abs(sweep_s)) - frames[i].odom_T_robot);
    scan.sweep_time_s = static_cast<float>(std::abs(sweep_s));
  }
  frames.pop_back();
  return frames;
}

std::vector<Frame> with_sweep_time(std::vector<Frame> frames, double sweep_s) {
  for (Frame& frame : frames) frame.scan.sweep_time_s = static_cast<float>(sweep_s);
  return frames;
}

std::vector<Frame> without_odometry(std::vector<Frame> frames) {
  for (Frame& frame : frames) {
    frame.has_odometry = false;
    frame.odom_T_robot = {0, 0, 0};
  }
  return frames;
}

TEST(Bent, is_undone_by_deskewed) {
  SimulatedRun run = simulated_run({{0.05, 3, 1}});
  for (const float sweep_s : {0.1F, -0.1F}) {
    LaserScan scan = run.scan(0);
    scan.robot_T_laser = {0.2, 0.1, 0.3};
    scan.sweep_time_s = sweep_s;
    const TPose2D motion{0.05, 0.01, 0.1};
    const LaserScan still = deskewed(bent(scan, motion), motion);
    for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
      EXPECT_NEAR(still.ranges_m[i], scan.ranges_m[i], 1e-5);
      EXPECT_NEAR((*still.bearings_rad)[i], (*scan.bearings_rad)[i], 1e-5);
    }
  }
}

// ---- Logs of real lasers, whose scans are hardly bent ----

/// Name of a log and the sweep time of the bent scans, seconds.
class BentLog : public testing::TestWithParam<std::pair<const char*, double>> {
 protected:
  void SetUp() override {
    const auto path = shared_file(GetParam().first);
    if (!path) GTEST_SKIP() << kNeedsData;
    const auto log = open_log(*path);
    while (frames_.size() < 3000) {
      auto frame = log->next();
      if (!frame) break;
      frames_.push_back(std::move(*frame));
    }
  }

  std::vector<Frame> frames_;
  double sweep_s_ = GetParam().second;
};

TEST_P(BentLog, shows_that_the_first_beam_is_measured_first) {
  EXPECT_EQ(study(bent(frames_, sweep_s_)).direction(), SweepDirection::kForward);
}

TEST_P(BentLog, shows_that_the_last_beam_is_measured_first) {
  EXPECT_EQ(study(bent(frames_, -sweep_s_)).direction(), SweepDirection::kBackward);
}

TEST_P(BentLog, stays_undecided_without_bends) {
  EXPECT_EQ(study(with_sweep_time(frames_, sweep_s_)).direction(), SweepDirection::kAuto);
}

TEST_P(BentLog, needs_no_odometry) {
  EXPECT_EQ(study(without_odometry(bent(frames_, sweep_s_))).direction(), SweepDirection::kForward);
  EXPECT_EQ(study(without_odometry(bent(frames_, -sweep_s_))).direction(), SweepDirection::kBackward);
  EXPECT_EQ(study(without_odometry(with_sweep_time(frames_, sweep_s_))).direction(), SweepDirection::kAuto);
}

INSTANTIATE_TEST_SUITE_P(Logs, BentLog,
                         testing::Values(std::pair{"intel.clf.gz", 0.1}, std::pair{"intel.clf.gz", 0.18},
                                         std::pair{"mit-csail.clf.gz", 0.1},
                                         std::pair{"mit-csail.clf.gz", 0.18}, std::pair{"fr079.clf.gz", 0.1},
                                         std::pair{"fr079.clf.gz", 0.18}));

// ---- A simulated robot ----

std::vector<Frame> frames_of_run(const SimulatedRun& run) {
  std::vector<Frame> frames(run.truth.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].index = i;
    frames[i].time_us = static_cast<TimeUs>(i) * 200'000;
    frames[i].odom_T_robot = run.odometry[i];
    frames[i].scan = run.scan(i);
  }
  return frames;
}

TEST(SweepDirectionStudyTest, is_undecided_if_the_robot_never_turns) {
  const auto frames = bent(frames_of_run(simulated_run({{0.05, 0, 100}, {-0.05, 0, 100}})), -0.18);
  const SweepDirectionStudy result = study(frames);
  EXPECT_EQ(result.pairs, 0U);
  EXPECT_EQ(result.direction(), SweepDirection::kAuto);
  EXPECT_FALSE(result.shows_no_sweep());
}

TEST(SweepDirectionStudyTest, has_no_scans_without_a_sweep_time) {
  const auto frames = frames_of_run(round_trips(1));
  EXPECT_EQ(study(frames).scans, 0U);
  EXPECT_GT(study(frames, 0.1).scans, 100U);
  EXPECT_EQ(study(with_sweep_time(frames, 0.1), 0.0).scans, 0U) << "the user states that there is no sweep";
}

TEST(SweepDirectionStudyTest, waits_for_a_robot_that_stands_before_it_turns) {
  std::vector<RunPart> parts = round_trip();
  for (const RunPart& part : round_trip()) parts.push_back(part);
  parts.insert(parts.begin(), {0, 0, 1600});
  EXPECT_EQ(study(bent(frames_of_run(simulated_run(parts)), -0.18)).direction(), SweepDirection::kBackward);
}

TEST(SweepDirectionStudyTest, shows_that_scans_are_not_bent) {
  SimulatedRun run = round_trips(2);
  const SweepDirectionStudy result = study(with_sweep_time(frames_of_run(run), 0.18));
  EXPECT_TRUE(result.shows_no_sweep());
  EXPECT_EQ(result.direction(), SweepDirection::kAuto);
}

TEST(SweepDirectionStudyTest, is_not_misled_by_a_mirrored_laser) {
  SimulatedRun run = round_trips(2);
  for (float& bearing : run.bearings_rad) bearing = -bearing;
  std::vector<Frame> frames = bent(frames_of_run(run), 0.18);
  EXPECT_EQ(study(frames).direction(), SweepDirection::kForward) << "read as it is mounted";
  for (Frame& frame : frames) {
    std::vector<float> bearings = *frame.scan.bearings_rad;
    for (float& bearing : bearings) bearing = -bearing;
    frame.scan.bearings_rad = std::make_shared<const std::vector<float>>(std::move(bearings));
  }
  EXPECT_NE(study(frames).direction(), SweepDirection::kBackward) << "read with the wrong mount";
}

// ---- Whole logs ----

class SweepDirectionOfLog : public testing::Test {
 protected:
  void record(const std::vector<SwingingLaser>& lasers, double rate_rad_s = 1) {
    write_mcap(path_, swinging_robot(lasers, rate_rad_s));
  }

  std::vector<Frame> frames(SweepDirection direction) {
    LogOptions options;
    options.sweep_direction = direction;
    return frames_of(path_, options);
  }

  std::vector<std::string> assumptions(SweepDirection direction = SweepDirection::kAuto) {
    LogOptions options;
    options.sweep_direction = direction;
    const auto log = open_log(path_, options);
    all_frames(*log);
    return log->assumptions();
  }

  static void expect_equal(const LaserScan& a, const LaserScan& b) {
    EXPECT_EQ(a.sweep_time_s, b.sweep_time_s);
    EXPECT_EQ(a.ranges_m, b.ranges_m);
    EXPECT_EQ(*a.bearings_rad, *b.bearings_rad);
  }

  void expect_same_scans(SweepDirection one, SweepDirection other) {
    const auto a = frames(one);
    const auto b = frames(other);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      SCOPED_TRACE(i);
      expect_equal(a[i].scan, b[i].scan);
    }
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "run.mcap";
};

TEST_F(SweepDirectionOfLog, auto_equals_the_true_direction) {
  record({SwingingLaser{}});
  expect_same_scans(SweepDirection::kAuto, SweepDirection::kForward);
  EXPECT_THAT(assumptions(), IsEmpty());

  record({SwingingLaser{"/scan", true}});
  expect_same_scans(SweepDirection::kAuto, SweepDirection::kBackward);
  EXPECT_THAT(assumptions(), testing::ElementsAre("the beams of each scan are measured in the reverse order "
                                                  "of the log, as the scans show in turns. State the order "
                                                  "with log.sweep_direction"));
  EXPECT_THAT(assumptions(SweepDirection::kBackward), IsEmpty());
  const auto bent = frames(SweepDirection::kForward);
  const auto straight = frames(SweepDirection::kBackward);
  EXPECT_NE(*bent[5].scan.bearings_rad, *straight[5].scan.bearings_rad);
}

TEST_F(SweepDirectionOfLog, auto_takes_the_stated_direction_if_the_scans_show_none) {
  record({SwingingLaser{"/scan", true}}, 0.0);
  expect_same_scans(SweepDirection::kAuto, SweepDirection::kForward);
  record({SwingingLaser{"/scan", false, 0}});
  expect_same_scans(SweepDirection::kAuto, SweepDirection::kForward);
  EXPECT_THAT(assumptions(), IsEmpty());
}

TEST_F(SweepDirectionOfLog, a_negative_time_increment_states_the_backward_order) {
  record({SwingingLaser{"/scan", true, 0.15, -0.15}});
  expect_same_scans(SweepDirection::kAuto, SweepDirection::kBackward);
  EXPECT_THAT(assumptions(), IsEmpty());

  record({SwingingLaser{"/scan", false, 0.15, -0.15}});
  expect_same_scans(SweepDirection::kAuto, SweepDirection::kForward);
  EXPECT_THAT(assumptions(), testing::ElementsAre(HasSubstr("measured in the order of the log")));
}

TEST_F(SweepDirectionOfLog, each_laser_has_its_own_direction) {
  record({SwingingLaser{"/front"}, SwingingLaser{"/rear", true}});
  const auto found = frames(SweepDirection::kAuto);
  const auto forward = frames(SweepDirection::kForward);
  const auto backward = frames(SweepDirection::kBackward);
  ASSERT_EQ(found.size(), forward.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    SCOPED_TRACE(i);
    expect_equal(found[i].scan, forward[i].scan);
    ASSERT_EQ(found[i].companions.size(), 1U);
    expect_equal(found[i].companions[0].scan, backward[i].companions[0].scan);
  }
  EXPECT_THAT(assumptions(), testing::ElementsAre(HasSubstr("each scan of laser 2 of /front, /rear are")));
}

TEST_F(SweepDirectionOfLog, scans_without_odometry_keep_their_beams_and_state_the_direction) {
  record({SwingingLaser{"/scan", true}});
  LogOptions options;
  options.odometry = "none";
  const auto frames = frames_of(path_, options);
  ASSERT_GT(frames.size(), 100U);
  for (const Frame& frame : frames) EXPECT_NEAR(frame.scan.sweep_time_s, -0.15, 1e-5);
}

TEST(SweepDirectionOfBags, public_bags_are_not_backward) {
  for (const char* name : {"bags/jarvis_circular_path_fast.bag", "bags/guardian_controller_2.bag"}) {
    const auto path = shared_file(name);
    if (!path) GTEST_SKIP() << kNeedsData;
    const auto log = open_log_reader(*path, {});
    for (const SweepDirectionStudy& laser : study_sweep_directions(*log, {}))
      EXPECT_NE(laser.direction(), SweepDirection::kBackward) << name;
  }
}

}  // namespace
}  // namespace psi_slam
