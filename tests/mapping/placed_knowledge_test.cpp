// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/placed_knowledge.h"

#include <gmock/gmock.h>

#include <stdexcept>
#include <vector>

namespace psi_slam {
namespace {

/// Returns frames with these times in seconds, 1 m apart.
std::vector<FrameRecord> frames_at(const std::vector<TimeUs>& times_s) {
  std::vector<FrameRecord> frames(times_s.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].time_us = times_s[i] * 1'000'000;
    frames[i].front_end_T_robot.x = static_cast<double>(i);
  }
  return frames;
}

TEST(PlacedKnowledge, the_scan_of_a_pose_decides_where_times_are_equal_or_run_backwards) {
  const std::vector<FrameRecord> frames = frames_at({10, 11, 12, 12, 11, 12, 13});
  const std::vector<std::size_t> node_frames{0, 2, 3, 4, 6};
  for (std::size_t node = 0; node < node_frames.size(); ++node) {
    KnownPose pose;
    pose.scan = node_frames[node];
    pose.time_us = frames[*pose.scan].time_us;
    pose.site_T_robot = {{1, 2, 0}, 0.05, 0.01};
    FixedKnowledge knowledge;
    knowledge.poses.push_back(pose);
    const PlacedKnowledge placed(knowledge, frames, node_frames, {});
    ASSERT_EQ(placed.landmarks().size(), 1U);
    const LandmarkSighting& robot = placed.landmarks().front().sightings.front();
    EXPECT_EQ(robot.node, node);
    EXPECT_EQ(robot.node_T_mark.pose, mrpt::math::TPose2D(0, 0, 0));
  }
}

TEST(PlacedKnowledge, a_scan_that_is_no_node_is_a_bug) {
  FixedKnowledge knowledge;
  knowledge.poses.push_back({11'000'000, {{1, 2, 0}, 0.05, 0.01}});
  knowledge.poses.front().scan = 1;
  EXPECT_THROW(PlacedKnowledge(knowledge, frames_at({10, 11, 12}), {0, 2}, {}), std::logic_error);
}

}  // namespace
}  // namespace psi_slam
