// SPDX-License-Identifier: BSD-3-Clause
// Maps a real log that is changed as if the robot had been switched off in between: it restarts where it
// stood, or is carried elsewhere while it is off.
#include <gtest/gtest.h>

#include <vector>

#include "log_files.h"
#include "map/exports/mapped_trajectory.h"
#include "map/trajectory/relations_metric.h"
#include "mapping/mapper_options.h"
#include "psi_slam/mapper.h"
#include "same_map.h"
#include "shared_logs.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr TimeUs kPause_us = 30'000'000;

class InterruptedLog : public testing::Test {
 protected:
  void SetUp() override {
    const auto log = shared_file("mit-csail.clf.gz");
    const auto relations = shared_file("mit-csail.relations");
    if (!log || !relations) GTEST_SKIP() << kNeedsData;
    LogOptions options;  // as in ini/mit-csail.ini
    options.beam_angles = BeamAngles::kCentredStepInclusive;
    options.max_range_m = 50;
    frames_ = frames_of(*log, options);
    relations_ = read_relations(*relations);
  }

  static MappingResult map_of(const std::vector<Frame>& frames, bool ahead = false) {
    MapperOptions options;
    options.back_end_thread = ahead;
    Mapper mapper(options);
    if (ahead) mapper.run_ahead(1000);
    for (const Frame& frame : frames) mapper.add(frame);
    return mapper.finish();
  }

  double error_m(const std::vector<FrameRecord>& frames) const {
    return evaluate_relations(trajectory_of(frames), relations_).translation_abs_m.mean;
  }

  std::vector<Frame> frames_;
  std::vector<Relation> relations_;
};

TEST_F(InterruptedLog, continues_after_a_pause_that_resets_odometry) {
  const std::size_t restart = frames_.size() / 2;
  const TPose2D odom_T_restart = frames_[restart].odom_T_robot;
  for (std::size_t i = restart; i < frames_.size(); ++i) {
    frames_[i].time_us += kPause_us;
    frames_[i].odom_T_robot = frames_[i].odom_T_robot - odom_T_restart;
  }
  MappingResult result = map_of(frames_);
  EXPECT_TRUE(result.interruptions.empty()) << "the robot is where it stood";
  for (std::size_t i = restart; i < result.frames.size(); ++i) result.frames[i].time_us -= kPause_us;
  EXPECT_LE(error_m(result.frames), 0.03);
}

TEST_F(InterruptedLog, finds_a_robot_again_that_was_carried_elsewhere) {
  const std::size_t off = frames_.size() * 45 / 100;
  const std::size_t on = frames_.size() * 6 / 10;
  const TPose2D odom_T_off = frames_[off - 1].odom_T_robot;
  const TPose2D odom_T_on = frames_[on].odom_T_robot;
  for (std::size_t i = on; i < frames_.size(); ++i)
    frames_[i].odom_T_robot = odom_T_off + (frames_[i].odom_T_robot - odom_T_on);
  frames_.erase(frames_.begin() + static_cast<std::ptrdiff_t>(off),
                frames_.begin() + static_cast<std::ptrdiff_t>(on));
  for (std::size_t i = 0; i < frames_.size(); ++i) frames_[i].index = i;
  const MappingResult result = map_of(frames_);
  ASSERT_EQ(result.interruptions.size(), 1U);
  const Interruption& interruption = result.interruptions.front();
  ASSERT_TRUE(interruption.found_frame);
  expect_same_map(result, map_of(frames_, true));
  std::size_t whole_maps = 0;
  for (const LoopRecord& loop : result.loops) {
    if (loop.window.theta_rad < 3) continue;
    EXPECT_EQ(loop.matcher, MatcherKind::kGa);
    ++whole_maps;
  }
  EXPECT_GT(whole_maps, 0U);
  EXPECT_LE(error_m(result.frames), 0.03);
}

}  // namespace
}  // namespace psi_slam
