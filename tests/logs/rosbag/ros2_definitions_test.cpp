// SPDX-License-Identifier: BSD-3-Clause
#include "logs/rosbag/ros2_definitions.h"

#include <gmock/gmock.h>

#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace psi_slam {
namespace {

const std::string kSeparator(80, '=');

TEST(Ros2DefinitionsTest, nested_types_follow_each_once) {
  EXPECT_EQ(ros2_definition("tf2_msgs/TFMessage"), "geometry_msgs/TransformStamped[] transforms\n" +
                                                       kSeparator +
                                                       "\nMSG: geometry_msgs/TransformStamped\n"
                                                       "std_msgs/Header header\n"
                                                       "string child_frame_id\n"
                                                       "geometry_msgs/Transform transform\n" +
                                                       kSeparator +
                                                       "\nMSG: std_msgs/Header\n"
                                                       "builtin_interfaces/Time stamp\n"
                                                       "string frame_id\n" +
                                                       kSeparator +
                                                       "\nMSG: geometry_msgs/Transform\n"
                                                       "geometry_msgs/Vector3 translation\n"
                                                       "geometry_msgs/Quaternion rotation\n" +
                                                       kSeparator +
                                                       "\nMSG: builtin_interfaces/Time\n"
                                                       "int32 sec\n"
                                                       "uint32 nanosec\n" +
                                                       kSeparator +
                                                       "\nMSG: geometry_msgs/Vector3\n"
                                                       "float64 x\n"
                                                       "float64 y\n"
                                                       "float64 z\n" +
                                                       kSeparator +
                                                       "\nMSG: geometry_msgs/Quaternion\n"
                                                       "float64 x\n"
                                                       "float64 y\n"
                                                       "float64 z\n"
                                                       "float64 w\n");
}

TEST(Ros2DefinitionsTest, every_recorded_type_is_defined_completely) {
  const std::regex member(R"(([a-z0-9]+|[a-z0-9_]+/[A-Z][A-Za-z0-9]*)(\[\d*\])? [a-z][a-z0-9_]*)");
  for (const std::string type :
       {"sensor_msgs/LaserScan", "sensor_msgs/MultiEchoLaserScan", "sensor_msgs/PointCloud2",
        "sensor_msgs/Imu", "nav_msgs/Odometry", "tf2_msgs/TFMessage", "rosgraph_msgs/Clock"}) {
    SCOPED_TRACE(type);
    std::istringstream lines(ros2_definition(type));
    std::set<std::string> used;
    std::set<std::string> defined;
    std::size_t members = 0;  // of the current type
    for (std::string line; std::getline(lines, line);) {
      std::smatch parts;
      if (line == kSeparator) {
        EXPECT_GT(members, 0U);
        members = 0;
        ASSERT_TRUE(std::getline(lines, line));
        ASSERT_EQ(line.substr(0, 5), "MSG: ");
        EXPECT_TRUE(defined.insert(line.substr(5)).second) << line;
        continue;
      }
      ASSERT_TRUE(std::regex_match(line, parts, member)) << line;
      ++members;
      if (parts[1].str().find('/') != std::string::npos) used.insert(parts[1]);
    }
    EXPECT_GT(members, 0U);
    EXPECT_EQ(used, defined);
  }
}

TEST(Ros2DefinitionsTest, other_types_have_none) {
  EXPECT_EQ(ros2_definition("my_msgs/Other"), "");
}

}  // namespace
}  // namespace psi_slam
