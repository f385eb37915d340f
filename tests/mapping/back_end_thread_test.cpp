// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/back_end_thread.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <thread>
#include <vector>

#include "local_maps/simulated_drive.h"
#include "mapping/mapper_options.h"
#include "psi_slam/mapper.h"
#include "same_map.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

// One and a half rounds of a corridor with poor odometry, so that loops move the map.
const std::vector<Frame>& rounds() {
  static const std::vector<Frame> frames = [] {
    OdometryErrors errors;
    errors.length_factor = 0.96;
    errors.turn_factor = 1.05;
    errors.drift_rad_per_m = 0.01;
    return drive_along(office_floor(),
                       path_along({{1.6, 1.6}, {18.3, 1.6}, {18.3, 12.4}, {1.6, 12.4}, {1.6, 1.6}, {14, 1.6}},
                                  0.16, 0.12),
                       errors, 11)
        .frames;
  }();
  return frames;
}

struct LiveRun {
  std::vector<TPose2D> map_T_robot;              ///< poses as add() returned them
  std::vector<std::vector<TPose2D>> map_T_node;  ///< poses of the nodes after each frame
  std::size_t missed_deadlines = 0;
  MappingResult result;
};

/// Options with little work at the end.
MapperOptions options_with(bool thread) {
  MapperOptions options;
  options.back_end_thread = thread;
  options.back_end.final_search.passes = 1;
  options.back_end.joint_refinement.rounds = 0;
  return options;
}

LiveRun run(std::size_t latency_nodes, bool thread) {
  MapperOptions options = options_with(thread);
  options.latency_nodes = latency_nodes;
  Mapper mapper(options);
  LiveRun live;
  for (const Frame& frame : rounds()) {
    live.map_T_robot.push_back(mapper.add(frame).map_T_robot);
    live.map_T_node.push_back(mapper.node_poses());
  }
  live.missed_deadlines = mapper.missed_deadlines();
  live.result = mapper.finish();
  return live;
}

const LiveRun& at_once() {
  static const LiveRun live = run(0, false);
  return live;
}

TEST(BackEndThread, the_finished_map_depends_neither_on_the_thread_nor_on_the_latency) {
  ASSERT_GT(at_once().result.loops.size(), 0U);
  for (const std::size_t latency : {0U, 1U, 7U, 100'000U})
    for (const bool thread : {false, true}) {
      SCOPED_TRACE(latency);
      expect_same_map(at_once().result, run(latency, thread).result);
    }
}

TEST(BackEndThread, the_poses_while_mapping_do_not_depend_on_the_thread) {
  const LiveRun without = run(4, false);
  const LiveRun with = run(4, true);
  EXPECT_EQ(without.map_T_robot, with.map_T_robot);
  EXPECT_EQ(without.map_T_node, with.map_T_node);
  EXPECT_EQ(without.missed_deadlines, 0U);
}

TEST(BackEndThread, the_finished_map_does_not_depend_on_running_ahead) {
  Mapper mapper(options_with(true));
  const std::vector<Frame>& frames = rounds();
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (i % 100 == 0)
      mapper.run_ahead(i % 300 == 0 ? std::optional(50) : i % 300 == 100 ? std::optional(0) : std::nullopt);
    mapper.add(frames[i]);
  }
  expect_same_map(at_once().result, mapper.finish());
}

// Maps two runs with edits of loops in the first run, in the second one and after the map was finished.
MappingResult edited_runs(bool ahead) {
  const auto accepted =
      std::find_if(at_once().result.loops.begin(), at_once().result.loops.end(), [](const LoopRecord& loop) {
        return loop.state == LoopState::kAccepted && loop.frame < rounds().size() * 9 / 10;
      });
  if (accepted == at_once().result.loops.end()) throw std::logic_error("the drive has no such loop");
  const LoopEdit deleted{LoopEdit::Kind::kDelete, accepted->frame, accepted->local_map};
  const std::size_t second_run = accepted->frame + 20;
  Mapper mapper(options_with(ahead));
  if (ahead) mapper.run_ahead(1000);
  EXPECT_EQ(mapper.edit(deleted).state, LoopEditOutcome::State::kWaits);
  for (std::size_t i = 0; i < second_run; ++i) mapper.add(rounds()[i]);
  mapper.begin_run({mapper.node_poses().size() - 1, {}, {}});
  for (std::size_t i = second_run; i < rounds().size(); ++i) {
    mapper.add(rounds()[i]);
    if (i != second_run + 40) continue;
    EXPECT_EQ(mapper.edit({LoopEdit::Kind::kRestore, deleted.frame, deleted.local_map}).state,
              LoopEditOutcome::State::kDone);
  }
  mapper.reopen(mapper.finish({}, Mapper::AfterFinish::kReopen));
  EXPECT_EQ(mapper.edit(deleted).state, LoopEditOutcome::State::kDone);
  return mapper.finish();
}

TEST(BackEndThread, edits_and_a_second_run_do_not_depend_on_running_ahead) {
  const MappingResult expected = edited_runs(false);
  expect_same_map(expected, edited_runs(true));
  ASSERT_EQ(expected.later_run_frames.size(), 1U);
  EXPECT_TRUE(std::any_of(expected.loops.begin(), expected.loops.end(), [](const LoopRecord& loop) {
    return rejected_by(loop, LoopRejection::Reason::kDeletedByHand);
  }));
}

TEST(BackEndThread, an_edit_that_cannot_be_made_yet_is_not_waited_for) {
  MapperOptions options;
  options.latency_nodes = 1000;
  options.back_end_thread = true;
  Mapper mapper(options);
  EXPECT_EQ(mapper.edit({LoopEdit::Kind::kDelete, 0, 999}).state, LoopEditOutcome::State::kWaits);
  for (std::size_t i = 0; i < 40; ++i) mapper.add(rounds()[i]);
  EXPECT_EQ(mapper.frames()[39].eta, 0) << "the result of the newest frame was taken early";
}

TEST(BackEndThread, an_observer_that_throws_loses_no_frame) {
  for (const std::size_t latency : {0U, 1U, 7U})
    for (const bool thread : {false, true}) {
      SCOPED_TRACE(latency);
      MapperOptions options = options_with(thread);
      options.latency_nodes = latency;
      Mapper mapper(options);
      std::size_t told = 0;
      mapper.set_pose_observer([&](const FrameRecord&) {
        if (told++ % 10 < 2) throw std::runtime_error("the observer fails");
      });
      std::size_t failures = 0;
      for (const Frame& frame : rounds()) {
        try {
          mapper.add(frame);
        } catch (const std::runtime_error&) {
          ++failures;
        }
      }
      EXPECT_GT(failures, 50U);
      expect_same_map(at_once().result, mapper.finish());
    }
}

TEST(BackEndThread, running_ahead_corrects_the_map_at_the_next_frame) {
  for (const bool is_observed : {false, true}) {
    MapperOptions options;
    options.latency_nodes = 100'000;
    options.back_end_thread = false;  // so that all results have arrived
    Mapper mapper(options);
    mapper.run_ahead(1000);
    if (is_observed) mapper.set_pose_observer([](const FrameRecord&) {});
    for (const Frame& frame : rounds()) mapper.add(frame);
    const std::vector<TPose2D>& expected = at_once().map_T_node[rounds().size() - 2];
    double largest_m = 0;
    for (std::size_t node = 0; node < expected.size(); ++node)
      largest_m = std::max(largest_m, std::hypot(mapper.node_poses()[node].x - expected[node].x,
                                                 mapper.node_poses()[node].y - expected[node].y));
    EXPECT_EQ(largest_m < 1e-9, !is_observed) << largest_m;
    mapper.end_log();
    EXPECT_EQ(mapper.node_poses() == mapper.graph().poses(), !is_observed);
  }
}

// Pose of the front end's frame in the map when the frame was added.
TPose2D map_T_local(const LiveRun& live, std::size_t frame) {
  const TPose2D& local_T_robot = live.result.frames[frame].front_end_T_robot;
  return live.map_T_robot[frame] + (TPose2D(0, 0, 0) - local_T_robot);
}

TEST(BackEndThread, corrections_arrive_after_the_latency) {
  constexpr std::size_t kLatency = 4;
  const LiveRun late = run(kLatency, true);
  const std::vector<std::size_t>& nodes = late.result.node_frames;
  double largest_m = 0;
  for (std::size_t node = kLatency; node < nodes.size(); ++node) {
    const TPose2D now = map_T_local(late, nodes[node]);
    const TPose2D before = map_T_local(at_once(), nodes[node - kLatency]);
    ASSERT_NEAR(now.x, before.x, 1e-9) << "node " << node;
    ASSERT_NEAR(now.y, before.y, 1e-9) << "node " << node;
    ASSERT_NEAR(now.phi, before.phi, 1e-9) << "node " << node;
    const TPose2D at_this_node = map_T_local(at_once(), nodes[node]);
    largest_m = std::max(largest_m, std::hypot(now.x - at_this_node.x, now.y - at_this_node.y));
  }
  EXPECT_GT(largest_m, 0.01) << "no loop has moved the map, so nothing was tested";
}

TEST(BackEndThread, the_poses_of_the_nodes_follow_the_corrections) {
  const LiveRun late = run(4, true);
  for (std::size_t frame = 0; frame < late.map_T_node.size(); ++frame) {
    const auto& nodes = late.result.node_frames;
    const auto count = std::upper_bound(nodes.begin(), nodes.end(), frame) - nodes.begin();
    ASSERT_EQ(late.map_T_node[frame].size(), static_cast<std::size_t>(count));
    if (late.result.frames[frame].node) {
      ASSERT_NEAR(late.map_T_node[frame].back().x, late.map_T_robot[frame].x, 1e-9);
      ASSERT_NEAR(late.map_T_node[frame].back().y, late.map_T_robot[frame].y, 1e-9);
    }
  }
  // The loops have moved nodes that were added long before.
  const std::vector<TPose2D>& last = late.map_T_node.back();
  const std::vector<TPose2D>& middle = late.map_T_node[late.map_T_node.size() / 2];
  double largest_m = 0;
  for (std::size_t node = 0; node < middle.size(); ++node)
    largest_m = std::max(largest_m, std::hypot(last[node].x - middle[node].x, last[node].y - middle[node].y));
  EXPECT_GT(largest_m, 0.005);
}

TEST(BackEndThread, waiting_completes_the_records) {
  MapperOptions options;
  options.latency_nodes = 1000;
  options.back_end_thread = true;
  Mapper mapper(options);
  for (std::size_t i = 0; i < 40; ++i) mapper.add(rounds()[i]);
  const auto is_complete = [&] { return mapper.frames()[39].eta > 0; };
  EXPECT_FALSE(is_complete()) << "the result of the newest frame is never taken early";
  mapper.wait();
  EXPECT_TRUE(is_complete());
  EXPECT_EQ(mapper.graph().num_nodes(), mapper.node_poses().size());
}

TrackedFrame frame_without_node(std::size_t number) {
  TrackedFrame tracked;
  tracked.frame = number;
  return tracked;
}

// A step that no builder accepts: its node is in a local map whose anchor is not in the graph.
TrackedFrame impossible_frame() {
  TrackedFrame tracked;
  tracked.step.node = 0;
  tracked.step.points = std::make_shared<ScanPoints>();
  FrontEndStep::Membership nowhere{};
  nowhere.anchor = 17;
  nowhere.covariance = Eigen::Matrix3d::Identity();
  tracked.step.memberships.push_back(nowhere);
  return tracked;
}

TEST(BackEndThread, passes_exceptions_on) {
  for (const bool own_thread : {false, true}) {
    GraphBuilder builder{MapperOptions()};
    BackEndThread thread(builder, own_thread, own_thread ? ThreadPriority::kLow : ThreadPriority::kNormal);
    thread.hand_over({});
    thread.hand_over(impossible_frame());
    thread.hand_over({});
    EXPECT_EQ(thread.take().frame, 0U);
    EXPECT_THROW(thread.take(), std::exception);
    EXPECT_TRUE(thread.is_ready()) << "take() need not wait to throw";
    EXPECT_THROW(thread.take(), std::exception);
  }
}

TEST(BackEndThread, counts_the_frames_that_wait) {
  MapperOptions options;
  options.latency_nodes = 0;
  options.back_end_thread = true;
  // Searches that take longer than the scheduler ever gives one thread before the other.
  LoopCandidateOptions& windows = options.back_end.loop_closure.candidates;
  windows.min_window_m = windows.max_window.x_m;
  windows.min_window_rad = windows.max_window.theta_rad;
  options.back_end.psi.max_poses = 1e9;
  Mapper mapper(options);
  for (const Frame& frame : rounds()) mapper.add(frame);
  EXPECT_GT(mapper.missed_deadlines(), 0U) << "without latency, every loop search is waited for";
  EXPECT_LE(mapper.missed_deadlines(), rounds().size());
}

TEST(BackEndThread, many_frames_without_a_node_wake_the_thread) {
  GraphBuilder builder{MapperOptions()};
  BackEndThread thread(builder, true);
  thread.hand_over({});
  thread.take();
  std::this_thread::sleep_for(std::chrono::milliseconds(20));  // the thread waits now
  for (int frame = 0; frame < 1000; ++frame) thread.hand_over({});
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!thread.is_ready() && std::chrono::steady_clock::now() < give_up)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_TRUE(thread.is_ready());
}

TEST(BackEndThread, a_frame_without_a_node_can_be_taken_at_once) {
  GraphBuilder builder{MapperOptions()};
  BackEndThread thread(builder, true);
  for (std::size_t frame = 0; frame < 100; ++frame) {
    thread.hand_over(frame_without_node(frame));
    EXPECT_EQ(thread.take().frame, frame);
  }
}

TEST(BackEndThread, may_be_destroyed_while_frames_wait) {
  GraphBuilder builder{MapperOptions()};
  BackEndThread thread(builder, true);
  for (std::size_t frame = 0; frame < 1000; ++frame) thread.hand_over(frame_without_node(frame));
  EXPECT_EQ(thread.in_work(), 1000U);
}

}  // namespace
}  // namespace psi_slam
