// SPDX-License-Identifier: BSD-3-Clause
// psi-slam live, localize and play as programs, beside programs on Fast DDS, which ROS 2 uses by default.
// What psi-slam publishes is decoded by the code that Fast DDS generates, and a robot on Fast DDS sends what
// psi-slam maps.
#include <gmock/gmock.h>
#include <mrpt/maps/COccupancyGridMap2D.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "foreign_program.h"
#include "logs/frames/laser_readings.h"
#include "loopback_domain.h"
#include "ros2/ros2_node.h"
#include "simulated_run.h"
#include "temporary_folder.h"
#include "test_files.h"

#ifdef PSI_SLAM_FASTDDS_PEER

namespace psi_slam {
namespace {

using nlohmann::json;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr std::int64_t kStart_ns = 1'600'000'000'000'000'000;

/// What a robot sends that drives `scans` scans through a room, as lines for the peer.
std::string robot_lines(int scans, double pause_s) {
  const std::vector<Wall> walls = furnished_room();
  std::ostringstream lines;
  lines.precision(12);
  lines << "tf /tf_static base_link laser " << kStart_ns << " 0.2 0 0\n";
  for (int i = 0; i < scans; ++i) {
    const std::int64_t stamp_ns = kStart_ns + i * std::int64_t{100'000'000};
    const mrpt::math::TPose2D robot{2 + 0.03 * i, 1.5 + 0.3 * std::sin(0.1 * i), 0.05 * std::sin(0.2 * i)};
    lines << "tf /tf odom base_link " << stamp_ns << ' ' << robot.x << ' ' << robot.y << ' ' << robot.phi
          << '\n';
    const mrpt::math::TPose2D laser = robot + mrpt::math::TPose2D{0.2, 0, 0};
    lines << "scan /scan laser " << stamp_ns << " -3.14159274 0.0174532924 0.1 30";
    for (int beam = 0; beam < 360; ++beam)
      lines << ' ' << range_m(walls, {laser.x, laser.y, laser.phi - M_PI + beam * M_PI / 180});
    lines << "\nsleep " << pause_s << '\n';
  }
  return lines.str();
}

class Ros2Programs : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  /// Runs programs side by side, and returns what they print. Each line is a command of the shell, in which
  /// $psi_slam, $peer and $dir stand for the programs and the folder.
  std::string run(const std::string& commands) const {
    write_file(path("script"), "psi_slam=" PSI_SLAM_PROGRAM " peer=" PSI_SLAM_FASTDDS_PEER " dir=" +
                                   folder_.path().string() + "\n" + commands + "\nwait\n");
    return run_foreign("timeout 120 sh " + path("script") + " 2>&1").out;
  }

  /// Messages that a listener has printed to a file, by their topics.
  std::map<std::string, std::vector<json>> messages_of(const std::string& file) const {
    std::map<std::string, std::vector<json>> messages;
    std::ifstream lines(path(file));
    for (std::string line; std::getline(lines, line);) {
      json message = json::parse(line);
      messages[message.at("topic")].push_back(std::move(message));
    }
    return messages;
  }

  LoopbackDomain domain_;
  TemporaryFolder folder_;
};

TEST_F(Ros2Programs, MapsARobotOnFastDdsAndPublishesWhatOthersExpect) {
  write_file(path("robot"), robot_lines(120, 0.05));
  const std::string printed = run(R"(
$peer listen 22 /map OccupancyGrid:latched /map_metadata MapMetaData:latched /tf TFMessage /pose PoseWithCovarianceStamped \
  /trajectory Path:latched /psi_slam/loops MarkerArray:latched /diagnostics DiagnosticArray \
  ros_discovery_info ParticipantEntitiesInfo:latched >$dir/heard &
$psi_slam live --ros2 --idle-s 4 -q -o $dir/live --set live.map_period_s=1 --record $dir/run.mcap &
$peer publish $dir/robot
)");
  ASSERT_TRUE(std::filesystem::exists(path("live/map.yaml"))) << printed;
  auto heard = messages_of("heard");

  ASSERT_THAT(heard["/map"], Not(IsEmpty()));
  const json& map = heard["/map"].back();
  EXPECT_EQ(map["frame"], "map");
  EXPECT_EQ(map["cells"], map["width"].get<std::size_t>() * map["height"].get<std::size_t>());
  EXPECT_GT(map["occupied"], 100);
  EXPECT_GT(map["free"], 1000);
  EXPECT_GT(map["unknown"], 0);
  ASSERT_THAT(heard["/map_metadata"], Not(IsEmpty()));
  EXPECT_EQ(heard["/map_metadata"].back()["width"], map["width"]);

  // The transform and the pose agree: map_T_odom + odom_T_robot = map_T_robot, here near the true pose.
  ASSERT_GT(heard["/pose"].size(), 60);
  const json& pose = heard["/pose"].back();
  EXPECT_EQ(pose["stamp_ns"], kStart_ns + 119 * std::int64_t{100'000'000});
  EXPECT_NEAR(pose["pose"][0].get<double>(), 0.03 * 119, 0.05);
  EXPECT_GT(pose["covariance"][0], 0);
  EXPECT_EQ(pose["covariance"][14], 0) << "z is not estimated";
  std::vector<std::int64_t> stamps_ns;
  for (const json& message : heard["/tf"])
    for (const json& transform : message["transforms"])
      if (transform["frame"] == "map") {
        EXPECT_EQ(transform["child"], "odom");
        stamps_ns.push_back(transform["stamp_ns"]);
      }
  ASSERT_GT(stamps_ns.size(), heard["/pose"].size() + 40) << "20 a second, also between scans";
  EXPECT_GE(stamps_ns.back(), pose["stamp_ns"].get<std::int64_t>() + 100'000'000) << "the tolerance";

  ASSERT_THAT(heard["/trajectory"], Not(IsEmpty()));
  EXPECT_EQ(heard["/trajectory"].back()["last_stamp_ns"], pose["stamp_ns"]);
  ASSERT_THAT(heard["/psi_slam/loops"], Not(IsEmpty()));
  EXPECT_EQ(heard["/psi_slam/loops"].back()["markers"].size(), 3);
  ASSERT_THAT(heard["/diagnostics"], Not(IsEmpty()));
  EXPECT_THAT(heard["/diagnostics"].back()["status"][0]["message"].get<std::string>(), HasSubstr("map"));
  std::vector<std::string> nodes;
  for (const json& message : heard["ros_discovery_info"])
    for (const json& node : message["nodes"]) {
      nodes.push_back(node["name"]);
      EXPECT_GE(node["writers"], 8);
      EXPECT_GE(node["readers"], 2);
    }
  EXPECT_THAT(nodes, Contains("psi_slam"));

  run("$psi_slam $dir/run.mcap -q -o $dir/again");
  EXPECT_EQ(read_file(path("again/map.pgm")), read_file(path("live/map.pgm")));
  EXPECT_EQ(read_file(path("again/trajectory.tum")), read_file(path("live/trajectory.tum")));
}

TEST_F(Ros2Programs, ObeysCommandsWhileMapping) {
  write_file(path("robot"), robot_lines(100, 0.1));
  write_file(
      path("commands"),
      "sleep 7\nstring /psi_slam/command save_map now\nstring /psi_slam/command save_session now.session\n"
      "string /psi_slam/command save_map ../outside\nstring /psi_slam/command dance\nsleep 1\n"
      "string /psi_slam/command finish\nsleep 1\n");
  const std::string printed = run(R"(
$peer listen 25 /psi_slam/status String:latched >$dir/heard &
$psi_slam live --ros2 -q -o $dir/live &
$peer publish $dir/robot &
$peer publish $dir/commands
)");
  EXPECT_TRUE(std::filesystem::exists(path("live/now.yaml"))) << printed;
  EXPECT_TRUE(std::filesystem::exists(path("live/now.pgm")));
  EXPECT_TRUE(std::filesystem::exists(path("live/now.session")));
  EXPECT_FALSE(std::filesystem::exists(path("outside.yaml")));
  EXPECT_TRUE(std::filesystem::exists(path("live/report.html"))) << "finish ends the run";
  std::vector<std::string> answers;
  auto heard = messages_of("heard");
  for (const json& message : heard["/psi_slam/status"]) answers.push_back(message["data"]);
  EXPECT_THAT(answers, Contains(HasSubstr("save_map: wrote")));
  EXPECT_THAT(answers, Contains(HasSubstr("save_session: wrote")));
  EXPECT_THAT(answers, Contains(HasSubstr("without /")));
  EXPECT_THAT(answers, Contains(HasSubstr("unknown command \"dance\"")));
}

TEST_F(Ros2Programs, BeginsAgainAndThenLocalizesInTheNewMap) {
  write_file(path("robot"), robot_lines(260, 0.1));
  write_file(path("commands"),
             "sleep 7\nstring /psi_slam/command reset\nsleep 8\nstring /psi_slam/command localize\nsleep 6\n"
             "initialpose /initialpose map 0 0 0\nsleep 1\ninitialpose /initialpose map 0 0 0\nsleep 2\n"
             "string /psi_slam/command finish\nsleep 1\n");
  const std::string printed = run(R"(
$peer listen 34 /psi_slam/status String:latched /diagnostics DiagnosticArray /pose PoseWithCovarianceStamped >$dir/heard &
$psi_slam live --ros2 -q -o $dir/live &
$peer publish $dir/robot &
$peer publish $dir/commands
)");
  auto heard = messages_of("heard");
  std::vector<std::string> states;
  for (const json& message : heard["/diagnostics"]) states.push_back(message["status"][0]["message"]);
  EXPECT_THAT(states, Contains("localized")) << printed;
  std::vector<std::string> answers;
  for (const json& message : heard["/psi_slam/status"]) answers.push_back(message["data"]);
  EXPECT_THAT(answers, Contains(HasSubstr("reset: dropping the map")));
  EXPECT_THAT(answers, Contains(HasSubstr("localize: finishing the map")));
  EXPECT_THAT(answers, Contains(HasSubstr("initialpose")));
  // The map began again where the robot was, so the path is shorter than that of all scans.
  std::ifstream trajectory(path("live/trajectory.tum"));
  std::size_t lines = 0;
  for (std::string line; std::getline(trajectory, line);) ++lines;
  EXPECT_GT(lines, 10);
  EXPECT_LT(lines, 170);
}

TEST_F(Ros2Programs, GivesALargeMapToALateListenerAsAWhole) {
  mrpt::maps::COccupancyGridMap2D map(-100, 100, -100, 100, 0.05F);
  map.fill(0.5F);
  for (int i = 0; i < 4000; ++i) map.setCell(i, 2000, 0.0F);
  const auto node = std::make_shared<Ros2Node>(Ros2Options());
  node->publish_map(map);
  run("$peer listen 12 /map OccupancyGrid:latched >$dir/heard");
  auto heard = messages_of("heard");
  ASSERT_THAT(heard["/map"], testing::SizeIs(1));
  const json& message = heard["/map"].front();
  EXPECT_EQ(message["cells"], 16'000'000);
  EXPECT_EQ(message["occupied"], 4000);
  EXPECT_EQ(message["unknown"], 16'000'000 - 4000);
}

TEST_F(Ros2Programs, SaysThatAnotherProgramPublishesThePoseInTheMap) {
  write_file(path("robot"), robot_lines(80, 0.1));
  std::string other = "sleep 3\n";
  for (int i = 0; i < 40; ++i)
    other += "tf /tf map odom " + std::to_string(kStart_ns) + " 1 0 0\nsleep 0.2\n";
  write_file(path("other"), other);
  const std::string printed = run(R"(
$psi_slam live --ros2 --idle-s 4 -o $dir/live &
$peer publish $dir/other &
$peer publish $dir/robot
)");
  EXPECT_THAT(printed, HasSubstr("also publishes the transform from map to odom"));
  EXPECT_THAT(printed, HasSubstr("The map is in"));
}

}  // namespace
}  // namespace psi_slam

#else

TEST(Ros2Programs, NeedFastDds) {
  GTEST_SKIP() << "Fast DDS or its generator fastddsgen is not installed";
}

#endif
