// SPDX-License-Identifier: BSD-3-Clause
// psi-slam's node and a played robot, in one process, over the loopback interface.
#include "ros2/ros2_node.h"

#include <gmock/gmock.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "frames_in_memory.h"
#include "live/live_source.h"
#include "loopback_domain.h"
#include "psi_slam/open_log.h"
#include "ros2/log_player.h"
#include "same_frames.h"
#include "simulated_run.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;

/// A log of a robot with a laser of 360 degrees, with odometry of six decimals.
std::vector<Frame> driven_frames(int scans) {
  std::vector<Frame> frames;
  const std::vector<Wall> walls = furnished_room();
  const auto bearings =
      std::make_shared<const std::vector<float>>(make_bearings_rad(BeamAngles::kLeftOpen, 360, 2 * M_PI));
  for (int i = 0; i < scans; ++i) {
    Frame frame;
    frame.index = static_cast<std::size_t>(i);
    frame.time_us = 1'600'000'000'000'000 + i * TimeUs{100'000};
    const double angle_rad = std::round(0.01 * i * 1e6) / 1e6;
    frame.odom_T_robot = {2 + 0.02 * i, 1.5, angle_rad};
    frame.scan.bearings_rad = bearings;
    frame.scan.max_range_m = 30;
    frame.scan.robot_T_laser = {0.2, 0, 0};
    const mrpt::math::TPose2D laser = frame.odom_T_robot + frame.scan.robot_T_laser;
    for (const float bearing_rad : *bearings)
      frame.scan.ranges_m.push_back(static_cast<float>(
          range_m(walls, {laser.x, laser.y, laser.phi + static_cast<double>(bearing_rad)})));
    frames.push_back(std::move(frame));
  }
  return frames;
}

Ros2Options named(const std::string& name) {
  Ros2Options options;
  options.name = name;
  return options;
}

class Ros2NodeTest : public testing::Test {
 protected:
  LiveControl control() {
    return {[this] { return stop_.load(); },
            [this](const std::string& sentence) { sentences_ += sentence + "\n"; }};
  }

  LiveInput input(const Ros2Options& options) {
    LiveInput input;
    input.kind = LiveInput::Kind::kRos2;
    input.ros2_link = link_ = std::make_shared<Ros2Node>(options);
    input.idle_s = 3;
    return input;
  }

  LoopbackDomain domain_;
  TemporaryFolder folder_;
  std::atomic<bool> stop_ = false;
  std::string sentences_;
  std::shared_ptr<Ros2Link> link_;
};

// With type information, Cyclone DDS and Fast DDS 3 do not match, and neither says so.
TEST(Ros2Types, HaveNoTypeInformation) {
  for (const dds_topic_descriptor_t* type :
       {&sensor_msgs_msg_dds__LaserScan__desc, &tf2_msgs_msg_dds__TFMessage__desc,
        &nav_msgs_msg_dds__OccupancyGrid__desc, &visualization_msgs_msg_dds__MarkerArray__desc})
    EXPECT_EQ(type->type_information.sz, 0) << type->m_typename;
}

TEST_F(Ros2NodeTest, ReceivesTheFramesThatAPlayerSendsToTheLastBit) {
  const std::vector<Frame> sent = driven_frames(80);
  LiveInput live = input(named("psi_slam"));
  live.record = (folder_.path() / "run.mcap").string();
  const auto source = open_live(live, LogOptions(), control());
  std::thread robot([&] {
    LogPlayer player(named("player"));
    EXPECT_TRUE(player.wait_for_listener(driven_frames(1).front(), 20));
    for (const Frame& frame : sent) {
      player.publish(frame);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
  });
  FramesInMemory log(sent);
  EXPECT_EQ(expect_same_frames(*source, log), sent.size()) << sentences_;
  robot.join();

  const auto recorded = open_log(folder_.path() / "run.mcap", LogOptions());
  FramesInMemory again(sent);
  EXPECT_EQ(expect_same_frames(*recorded, again), sent.size());
}

TEST_F(Ros2NodeTest, ReadsOnlyTheTopicsOfItsNamespace) {
  Ros2Options robot1 = named("psi_slam");
  robot1.name_space = "/robot1";
  const auto source = open_live(input(robot1), LogOptions(), control());
  std::atomic<bool> is_heard = false;  // whether psi-slam has found /robot1
  const auto play = [&](const std::string& name_space, float range_m) {
    Ros2Options options = named("player");
    options.name_space = name_space;
    LogPlayer player(options);
    if (name_space == "/robot1") is_heard = player.wait_for_listener(driven_frames(1).front(), 20);
    while (!is_heard) std::this_thread::yield();
    for (Frame frame : driven_frames(20)) {
      frame.scan.ranges_m[0] = range_m;
      player.publish(frame);
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
  };
  std::thread first([&] { play("/robot1", 1.25F); });
  std::thread second([&] { play("/robot2", 2.5F); });
  std::size_t frames = 0;
  for (; const auto frame = source->next(); ++frames) EXPECT_EQ(frame->scan.ranges_m[0], 1.25F);
  EXPECT_EQ(frames, 20);
  first.join();
  second.join();
}

TEST_F(Ros2NodeTest, DropsScansWhilePaused) {
  const auto source = open_live(input(named("psi_slam")), LogOptions(), control());
  link_->pause(true);
  std::thread robot([&] {
    LogPlayer player(named("player"));
    EXPECT_TRUE(player.wait_for_listener(driven_frames(1).front(), 20));
    const std::vector<Frame> frames = driven_frames(30);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      if (i == 15) {
        std::this_thread::sleep_for(std::chrono::milliseconds(500));
        link_->pause(false);
      }
      player.publish(frames[i]);
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
  });
  std::vector<TimeUs> times;
  while (const auto frame = source->next()) times.push_back(frame->time_us);
  robot.join();
  ASSERT_EQ(times.size(), 15);
  EXPECT_EQ(times.front(), driven_frames(16).back().time_us);
}

TEST_F(Ros2NodeTest, NamesTheDomainInWhichTheRobotIs) {
  const DdsNetwork elsewhere{20, dds_network(std::nullopt).settings};  // never that of a LoopbackDomain
  const DdsNode robot(elsewhere, "driver", "/");
  LiveInput live = input(named("psi_slam"));
  live.idle_s = 9;
  const auto source = open_live(live, LogOptions(), control());
  EXPECT_THROW(source->next(), UserError);
  EXPECT_THAT(sentences_, HasSubstr("no scan for 5 s: no other node is in domain"));
  EXPECT_THAT(sentences_,
              HasSubstr("set ROS_DOMAIN_ID=" + std::to_string(elsewhere.domain) + " for the nodes"));
}

}  // namespace
}  // namespace psi_slam
