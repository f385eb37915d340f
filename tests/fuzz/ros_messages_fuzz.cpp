// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz_target.h"
#include "logs/rosbag/ros_messages.h"

/// Reads a message. The first byte chooses the type (bits 1 to 3) and the encoding (bit 0).
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace psi_slam;
  if (size == 0) return 0;
  constexpr const char* kTypes[] = {kRosLaserScan, kRosMultiEchoScan, kRosPointCloud, kRosImu,
                                    kRosOdometry,  kRosTransforms,    kRosLaserScan,  kRosPointCloud};
  const BagTopic topic{"/topic", kTypes[data[0] >> 1 & 7],
                       (data[0] & 1) != 0 ? BagEncoding::kCdr : BagEncoding::kRos1};
  const BagMessage message{&topic, 0, fuzz::text_of(data + 1, size - 1)};
  try {
    read_ros_header(message);
    if (topic.type == kRosLaserScan || topic.type == kRosMultiEchoScan) read_ros_laser_scan(message);
    if (topic.type == kRosPointCloud) read_ros_point_cloud(message);
    if (topic.type == kRosImu) read_ros_imu(message);
    if (topic.type == kRosOdometry) read_ros_odometry(message);
    if (topic.type == kRosTransforms) read_ros_transforms(message);
  } catch (const MalformedBytes&) {
    // The reader of bags adds the place and throws UserError.
  }
  return 0;
}
