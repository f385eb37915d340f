// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/repeated_scans.h"

#include <gmock/gmock.h>

#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "logs/frames/log_reader.h"
#include "logs/frames/look_over.h"
#include "simulated_run.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

Frame frame_of(const SimulatedRun& run, std::size_t i) {
  Frame frame;
  frame.index = i;
  frame.time_us = static_cast<TimeUs>(1e6 * SimulatedRun::kPeriod_s * static_cast<double>(i));
  frame.odom_T_robot = run.odometry[i];
  frame.scan = run.scan(i);
  return frame;
}

std::vector<Frame> frames_of(const SimulatedRun& run) {
  std::vector<Frame> frames;
  for (std::size_t i = 0; i < run.truth.size(); ++i) frames.push_back(frame_of(run, i));
  return frames;
}

std::vector<TimeUs> times_of(const std::vector<Frame>& frames) {
  std::vector<TimeUs> times;
  for (const Frame& frame : frames) times.push_back(frame.time_us);
  return times;
}

/// Returns the indices of the frames that repeat an earlier one.
std::vector<std::size_t> repeats_in(const std::vector<Frame>& frames, RepeatedScans&& finder = {}) {
  std::vector<std::size_t> repeats;
  for (const Frame& frame : frames)
    if (finder.repeats(frame)) repeats.push_back(frame.index);
  return repeats;
}

SimulatedRun without_noise(SimulatedRun run) {
  run.noise_m = 0;
  return run;
}

TEST(RepeatedScans, finds_an_older_scan_with_new_stamps) {
  std::vector<Frame> frames = frames_of(simulated_run({{0.08, 1.0, 60}}));
  for (const std::size_t stalled : {40U, 41U, 42U}) frames[stalled].scan.ranges_m = frames[35].scan.ranges_m;
  RepeatedScans finder;
  EXPECT_EQ(finder.sentence(), "");
  for (const Frame& frame : frames) finder.repeats(frame);
  EXPECT_EQ(
      finder.sentence(),
      "3 scans repeat the readings of an earlier scan although the robot moved (the first 8.0 s, the last "
      "8.4 s into the log), so they are left out: the laser stalled, or its driver publishes scans twice");
  EXPECT_THAT(repeats_in(frames), testing::ElementsAre(40, 41, 42));
}

TEST(RepeatedScans, remembers_the_last_eight_readings_of_a_laser_that_has_shown_five) {
  const auto repeats_after_copying = [](std::size_t from, std::size_t to) {
    std::vector<Frame> frames = frames_of(simulated_run({{0.08, 1.0, 60}}));
    frames[to].scan.ranges_m = frames[from].scan.ranges_m;
    return repeats_in(frames);
  };
  EXPECT_THAT(repeats_after_copying(32, 40), testing::ElementsAre(40));
  EXPECT_THAT(repeats_after_copying(31, 40), testing::IsEmpty());
  EXPECT_THAT(repeats_after_copying(4, 5), testing::ElementsAre(5));
  EXPECT_THAT(repeats_after_copying(3, 4), testing::IsEmpty());
}

/// A reader of frames in memory.
class ReaderOfFrames : public LogReader {
 public:
  explicit ReaderOfFrames(std::vector<Frame> frames) : frames_(std::move(frames)) {}
  double progress() const override { return 0; }
  std::size_t frames_taken() const { return next_; }

 protected:
  std::optional<Frame> read_frame() override {
    if (next_ == frames_.size()) return std::nullopt;
    return frames_[next_++];
  }

 private:
  std::vector<Frame> frames_;
  std::size_t next_ = 0;
};

TEST(RepeatedScans, that_a_reader_leaves_out_without_a_gyroscope_end_its_heading) {
  for (const bool knows_turn : {true, false}) {
    std::vector<Frame> frames = frames_of(simulated_run({{0.08, 1.0, 30}}));
    for (Frame& frame : frames) frame.imu_heading_rad = frame.odom_T_robot.phi;
    frames[20].scan.ranges_m = frames[19].scan.ranges_m;
    if (!knows_turn) frames[20].imu_heading_rad.reset();
    ReaderOfFrames reader(frames);
    for (std::size_t i = 0; i < frames.size() - 1; ++i) {
      const auto frame = reader.next();
      ASSERT_TRUE(frame);
      EXPECT_EQ(frame->index, i);
      EXPECT_EQ(frame->imu_heading_rad.has_value(), i != 20 || knows_turn) << i;
    }
    EXPECT_FALSE(reader.next());
  }
}

// One of two lasers is dead and gives one scan again and again.
TEST(RepeatedScans, of_a_laser_that_never_changes_are_awaited_only_once) {
  std::vector<Frame> frames;
  for (const Frame& frame : frames_of(simulated_run({{0.08, 1.0, 400}}))) {
    frames.push_back(frame);
    frames.push_back(frame);
    frames.back().scan.laser = 1;
    frames.back().scan.ranges_m = frames.at(1).scan.ranges_m;
  }
  ReaderOfFrames reader(frames);
  std::size_t given = 0;
  std::size_t most_ahead = 0;
  for (; reader.next(); ++given)
    if (given > LookOver::kMostScans) most_ahead = std::max(most_ahead, reader.frames_taken() - given);
  EXPECT_EQ(given, frames.size());
  EXPECT_LE(most_ahead, 2U);
}

TEST(RepeatedScans, at_the_beginning_are_left_out_as_soon_as_the_laser_has_shown_five_readings) {
  std::vector<Frame> frames = frames_of(simulated_run({{0.08, 1.0, 60}}));
  const auto given_times_of = [](const std::vector<Frame>& all) {
    ReaderOfFrames reader(all);
    std::vector<TimeUs> times;
    while (const auto frame = reader.next()) {
      EXPECT_EQ(frame->index, times.size());
      times.push_back(frame->time_us);
    }
    return std::pair(times, reader.contents().repeated_scans);
  };
  for (std::size_t i = 3; i < 30; ++i) frames[i].scan.ranges_m = frames[2].scan.ranges_m;
  const auto [times, sentence] = given_times_of(frames);
  ASSERT_EQ(times.size(), frames.size() - 27);
  EXPECT_EQ(times[2], frames[2].time_us);
  EXPECT_EQ(times[3], frames[30].time_us);
  EXPECT_THAT(sentence, testing::StartsWith("27 scans repeat the readings of an earlier scan although the "
                                            "robot moved (the first 0.6 s, the last 5.8 s into the log)"));
  for (std::size_t i = 30; i < frames.size(); ++i) frames[i].scan.ranges_m = frames[2].scan.ranges_m;
  EXPECT_EQ(given_times_of(frames), std::pair(times_of(frames), std::string()))
      << "the readings may not depend on the place";
}

TEST(RepeatedScans, judges_each_laser_by_itself) {
  std::vector<Frame> frames = frames_of(simulated_run({{0.08, 1.0, 60}}));
  for (const std::size_t stalled : {40U, 41U, 42U}) frames[stalled].scan.ranges_m = frames[35].scan.ranges_m;
  frames[41].scan.laser = 1;
  EXPECT_THAT(repeats_in(frames), testing::ElementsAre(40, 42));
}

TEST(RepeatedScans, turns_by_a_gyroscope_count_without_odometry) {
  std::vector<Frame> frames = frames_of(simulated_run({{0.0, 3.0, 60}}));
  for (Frame& frame : frames) {
    frame.has_odometry = false;
    frame.imu_heading_rad = frame.odom_T_robot.phi;
  }
  frames[41].scan.ranges_m = frames[40].scan.ranges_m;
  EXPECT_THAT(repeats_in(frames), testing::ElementsAre(41));
  for (Frame& frame : frames) frame.imu_heading_rad.reset();
  EXPECT_THAT(repeats_in(frames), testing::IsEmpty());
}

TEST(RepeatedScans, a_robot_that_stands_repeats_scans_without_noise) {
  SimulatedRun run = without_noise(simulated_run({{0.08, 1.0, 30}, {0, 0, 100}, {0.08, 1.0, 30}}));
  EXPECT_THAT(repeats_in(frames_of(run)), testing::IsEmpty());
  for (std::size_t i = 30; i < run.odometry.size(); ++i)  // odometry drifts by 1 mm/s
    run.odometry[i].x += 0.0002 * static_cast<double>(i - 30);
  EXPECT_THAT(repeats_in(frames_of(run)), testing::IsEmpty());
}

TEST(RepeatedScans, a_robot_that_comes_back_repeats_scans_without_noise) {
  // Forwards, back and around, by odometry with errors of 2 %.
  const SimulatedRun run =
      without_noise(simulated_run({{0.125, 0, 20}, {-0.125, 0, 20}, {0, 15, 24}, {0, 15, 24}}));
  std::vector<Frame> frames = frames_of(run);
  for (std::size_t i = 21; i <= 40; ++i) frames[i].scan.ranges_m = frames[40 - i].scan.ranges_m;
  for (std::size_t i = 65; i <= 88; ++i) frames[i].scan.ranges_m = frames[i - 24].scan.ranges_m;
  EXPECT_THAT(repeats_in(frames), testing::IsEmpty());
}

TEST(RepeatedScans, a_bare_corridor_looks_the_same_everywhere_without_noise) {
  SimulatedRun run = without_noise(simulated_run({{0.1, 0, 60}}, {5, 1, 0}));
  run.walls.clear();
  add_box(run.walls, -100, 0, 100, 2.5);
  for (TPose2D& pose : run.truth) pose.phi = 0;
  std::vector<Frame> frames = frames_of(run);
  for (Frame& frame : frames)
    for (float& range_m : frame.scan.ranges_m)
      range_m = range_m > 20 ? std::numeric_limits<float>::infinity() : std::round(range_m * 100) / 100;
  ASSERT_EQ(frames[10].scan.ranges_m, frames[50].scan.ranges_m);
  EXPECT_THAT(repeats_in(frames), testing::IsEmpty());
}

TEST(RepeatedScans, ignores_scans_without_shape) {
  std::vector<Frame> frames = frames_of(simulated_run({{0.08, 1.0, 60}}));
  for (const float value :
       {0.0F, 81.83F, std::numeric_limits<float>::infinity(), std::numeric_limits<float>::quiet_NaN()}) {
    for (Frame& frame : frames) frame.scan.ranges_m.assign(frame.scan.ranges_m.size(), value);
    EXPECT_THAT(repeats_in(frames), testing::IsEmpty());
  }
}

}  // namespace
}  // namespace psi_slam
