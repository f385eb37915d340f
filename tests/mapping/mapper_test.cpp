// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/mapping/mapper.h"

#include <gtest/gtest.h>
#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "../local_maps/simulated_drive.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

double distance_m(const TPose2D& a, const TPose2D& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

// Once round the corridor and the first leg again, with odometry that is biased and noisy.
const SimulatedDrive& office_drive() {
  static const SimulatedDrive drive = [] {
    OdometryErrors errors;
    errors.length_factor = 0.96;
    errors.length_share = 0.1;
    errors.turn_factor = 1.05;
    errors.turn_share = 0.1;
    errors.drift_rad_per_m = 0.01;
    return drive_along(
        office_floor(),
        path_along({{1.6, 1.6}, {18.3, 1.6}, {18.3, 12.4}, {1.6, 12.4}, {1.6, 1.6}, {14, 1.6}}, 0.16, 0.12),
        errors, 11);
  }();
  return drive;
}

MappingResult map_of(const std::vector<Frame>& frames, const MapperOptions& options = {}) {
  Mapper mapper(options);
  for (const Frame& frame : frames) mapper.add(frame);
  return mapper.finish();
}

const MappingResult& office_map() {
  static const MappingResult result = map_of(office_drive().frames);
  return result;
}

void expect_consistent(const MappingResult& result, std::size_t frames) {
  ASSERT_EQ(result.frames.size(), frames);
  ASSERT_EQ(result.log.size(), frames);
  ASSERT_EQ(result.graph.nodes.size(), result.node_frames.size());
  for (std::size_t i = 0; i < frames; ++i) {
    const TPose2D& pose = result.frames[i].map_T_robot;
    ASSERT_TRUE(std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.phi)) << "scan " << i;
    EXPECT_EQ(result.frames[i].time_us, result.log[i].time_us);
    if (result.frames[i].node) {
      ASSERT_LT(*result.frames[i].node, result.node_frames.size());
      EXPECT_EQ(result.node_frames[*result.frames[i].node], i);
    }
  }
  for (std::size_t node = 0; node < result.node_frames.size(); ++node) {
    ASSERT_LT(result.node_frames[node], frames);
    const FrameRecord& frame = result.frames[result.node_frames[node]];
    EXPECT_EQ(frame.node, node);
    ASSERT_EQ(result.graph.nodes.count(node), 1U) << "node " << node;
    const auto& pose = result.graph.nodes.at(node);
    EXPECT_NEAR(pose.x(), frame.map_T_robot.x, 1e-9);
    EXPECT_NEAR(pose.y(), frame.map_T_robot.y, 1e-9);
    EXPECT_NEAR(mrpt::math::wrapToPi(pose.phi() - frame.map_T_robot.phi), 0, 1e-9);
  }
  for (const LocalMapRecord& local_map : result.local_maps) {
    EXPECT_LE(local_map.first_node, local_map.last_node);
    EXPECT_LT(local_map.last_node, result.node_frames.size());
    EXPECT_EQ(local_map.anchor, local_map.first_node);
  }
  for (const LoopRecord& loop : result.loops) {
    ASSERT_LT(loop.local_map, result.local_maps.size());
    EXPECT_EQ(loop.anchor, result.local_maps[loop.local_map].anchor);
    EXPECT_EQ(loop.frame, result.node_frames[loop.node]);
    EXPECT_EQ(loop.verdict == LoopVerdict::kAccepted, loop.reason.empty()) << loop.reason;
    EXPECT_NE(loop.verdict, LoopVerdict::kPending) << "nothing is pending at the end";
  }
}

std::size_t accepted_loops(const MappingResult& result) {
  return static_cast<std::size_t>(
      std::count_if(result.loops.begin(), result.loops.end(),
                    [](const LoopRecord& loop) { return loop.verdict == LoopVerdict::kAccepted; }));
}

void expect_no_false_loop(const MappingResult& result, const std::vector<TPose2D>& truth) {
  for (const LoopRecord& loop : result.loops) {
    if (loop.verdict != LoopVerdict::kAccepted) continue;
    const TPose2D off =
        loop.anchor_T_node - (truth[result.node_frames[loop.node]] - truth[result.node_frames[loop.anchor]]);
    EXPECT_LT(std::hypot(off.x, off.y), 0.3) << loop.node << " seen from " << loop.anchor;
    EXPECT_LT(std::abs(off.phi), 0.1) << loop.node << " seen from " << loop.anchor;
  }
}

TEST(Mapper, brings_the_robot_home_after_a_loop) {
  const SimulatedDrive& drive = office_drive();
  const MappingResult& result = office_map();
  ASSERT_EQ(result.frames.size(), drive.frames.size());
  double odometry_m = 0;
  double map_m = 0;
  for (std::size_t i = 0; i < drive.frames.size(); ++i) {
    odometry_m = std::max(odometry_m, distance_m(drive.frames[i].odom_T_robot, drive.map_T_robot[i]));
    map_m = std::max(map_m, distance_m(result.frames[i].map_T_robot, drive.map_T_robot[i]));
  }
  EXPECT_GT(odometry_m, 3) << "odometry alone is hopeless";
  EXPECT_LT(map_m, 0.15);
  const TPose2D& last = result.frames.back().map_T_robot;
  EXPECT_LT(distance_m(last, drive.map_T_robot.back()), 0.15);
  EXPECT_LT(std::abs(mrpt::math::wrapToPi(last.phi - drive.map_T_robot.back().phi)), 0.02);
}

TEST(Mapper, accepts_true_loops_and_no_false_one) {
  EXPECT_GT(accepted_loops(office_map()), 5U);
  expect_no_false_loop(office_map(), office_drive().map_T_robot);
}

TEST(Mapper, closes_loops_while_it_maps_and_in_the_last_pass) {
  const auto& loops = office_map().loops;
  for (const bool in_last_pass : {false, true})
    EXPECT_TRUE(std::any_of(loops.begin(), loops.end(), [&](const LoopRecord& loop) {
      return loop.in_last_pass == in_last_pass && loop.verdict == LoopVerdict::kAccepted;
    })) << in_last_pass;
}

TEST(Mapper, every_scan_has_a_pose_and_the_graph_fits_them) {
  expect_consistent(office_map(), office_drive().frames.size());
  EXPECT_GT(office_map().node_frames.size(), 100U);
  EXPECT_GT(office_map().local_maps.size(), 3U);
}

TEST(Mapper, says_where_the_robot_is_while_it_maps) {
  const SimulatedDrive& drive = office_drive();
  MapperOptions options;
  options.last_pass.passes = 0;
  Mapper mapper(options);
  EXPECT_EQ(mapper.map_T_robot(), TPose2D(0, 0, 0));
  double largest_m = 0;
  for (std::size_t i = 0; i < 150; ++i) {
    const FrameRecord& record = mapper.add(drive.frames[i]);
    EXPECT_EQ(record.time_us, drive.frames[i].time_us);
    EXPECT_EQ(mapper.frames().size(), i + 1);
    EXPECT_EQ(mapper.log().size(), i + 1);
    largest_m = std::max(largest_m, distance_m(mapper.map_T_robot(), drive.map_T_robot[i]));
  }
  EXPECT_LT(largest_m, 0.15);
  EXPECT_GT(mapper.graph().num_nodes(), 50U);
}

TEST(Mapper, the_same_log_gives_the_same_poses_to_the_last_bit) {
  const MappingResult again = map_of(office_drive().frames);
  const MappingResult& first = office_map();
  ASSERT_EQ(again.frames.size(), first.frames.size());
  for (std::size_t i = 0; i < first.frames.size(); ++i) {
    ASSERT_EQ(again.frames[i].map_T_robot.x, first.frames[i].map_T_robot.x) << "scan " << i;
    ASSERT_EQ(again.frames[i].map_T_robot.y, first.frames[i].map_T_robot.y) << "scan " << i;
    ASSERT_EQ(again.frames[i].map_T_robot.phi, first.frames[i].map_T_robot.phi) << "scan " << i;
  }
  ASSERT_EQ(again.loops.size(), first.loops.size());
  for (std::size_t i = 0; i < first.loops.size(); ++i) {
    EXPECT_EQ(again.loops[i].node, first.loops[i].node);
    EXPECT_EQ(again.loops[i].verdict, first.loops[i].verdict);
    EXPECT_EQ(again.loops[i].response, first.loops[i].response);
  }
}

TEST(Mapper, without_loop_closing_the_front_ends_poses_stand) {
  MapperOptions options;
  options.close_loops = false;
  const std::vector<Frame>& frames = office_drive().frames;
  const MappingResult result = map_of(frames, options);
  expect_consistent(result, frames.size());
  EXPECT_TRUE(result.loops.empty());
  for (const FrameRecord& frame : result.frames) {
    EXPECT_EQ(frame.loops_tried, 0);
    EXPECT_NEAR(distance_m(frame.map_T_robot, frame.front_end_T_robot), 0, 1e-9);
  }
}

// The laser is covered for some metres of the far corridor, and odometry alone carries the robot through.
TEST(Mapper, mends_by_loops_what_it_lost_while_blind) {
  SimulatedDrive drive = office_drive();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 190; i < 250; ++i) {
    auto& ranges = drive.frames[i].scan.ranges_m;
    std::fill(ranges.begin(), ranges.end(), nan);
  }
  const auto error_m = [&](const MappingResult& result) {
    return distance_m(result.frames.back().map_T_robot, drive.map_T_robot.back());
  };
  MapperOptions open;
  open.close_loops = false;
  const double lost_m = error_m(map_of(drive.frames, open));
  const MappingResult result = map_of(drive.frames);
  expect_consistent(result, drive.frames.size());
  EXPECT_GT(lost_m, 0.5) << "the front end alone cannot know";
  EXPECT_LT(error_m(result), 0.15);
  EXPECT_GT(accepted_loops(result), 0U);
  expect_no_false_loop(result, drive.map_T_robot);
}

TEST(Mapper, finishing_reports_its_progress_up_to_the_end) {
  Mapper mapper({});
  for (const Frame& frame : office_drive().frames) mapper.add(frame);
  std::vector<double> shares;
  const MappingResult result = mapper.finish([&](double share) {
    shares.push_back(share);
    return share < 1;
  });
  ASSERT_FALSE(shares.empty());
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_GT(shares.front(), 0);
  EXPECT_EQ(shares.back(), 1);
  EXPECT_FALSE(result.interrupted) << "a stop when all is done stops nothing";
}

TEST(Mapper, the_last_pass_can_be_cut_short) {
  Mapper mapper({});
  for (const Frame& frame : office_drive().frames) mapper.add(frame);
  int calls = 0;
  const MappingResult result = mapper.finish([&](double) { return ++calls < 3; });
  EXPECT_EQ(calls, 3);
  EXPECT_TRUE(result.last_pass_cut_short);
  EXPECT_TRUE(result.interrupted);
  expect_consistent(result, office_drive().frames.size());
  EXPECT_LT(result.loops.size(), office_map().loops.size());
  EXPECT_LT(distance_m(result.frames.back().map_T_robot, office_drive().map_T_robot.back()), 0.2)
      << "the loops found until then hold";
}

TEST(Mapper, nothing_to_map_is_an_empty_map) {
  const MappingResult result = map_of({});
  expect_consistent(result, 0);
  EXPECT_TRUE(result.node_frames.empty());
  EXPECT_TRUE(result.loops.empty());
}

TEST(Mapper, one_scan_lies_at_the_origin) {
  Frame frame = office_drive().frames.front();
  frame.odom_T_robot = {7, -3, 1};
  const MappingResult result = map_of({frame});
  expect_consistent(result, 1);
  ASSERT_EQ(result.node_frames.size(), 1U);
  EXPECT_EQ(result.frames[0].map_T_robot, TPose2D(0, 0, 0));
  EXPECT_EQ(result.frames[0].odom_T_robot, TPose2D(7, -3, 1));
}

TEST(Mapper, scans_without_a_return_follow_odometry) {
  std::vector<Frame> frames(office_drive().frames.begin(), office_drive().frames.begin() + 60);
  for (Frame& frame : frames)
    std::fill(frame.scan.ranges_m.begin(), frame.scan.ranges_m.end(),
              std::numeric_limits<float>::quiet_NaN());
  const MappingResult result = map_of(frames);
  expect_consistent(result, frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i)
    EXPECT_LT(distance_m(result.frames[i].map_T_robot, frames[i].odom_T_robot - frames[0].odom_T_robot),
              1e-6);
}

TEST(Mapper, scans_without_a_beam_do_no_harm) {
  std::vector<Frame> frames(office_drive().frames.begin(), office_drive().frames.begin() + 60);
  for (std::size_t i = 0; i < frames.size(); i += 3) {
    frames[i].scan.ranges_m.clear();
    frames[i].scan.bearings_rad = std::make_shared<const std::vector<float>>();
  }
  const MappingResult result = map_of(frames);
  expect_consistent(result, frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i)
    EXPECT_LT(distance_m(result.frames[i].map_T_robot, office_drive().map_T_robot[i]), 0.2) << "scan " << i;
}

}  // namespace
}  // namespace psi_slam
