// SPDX-License-Identifier: BSD-3-Clause
#include "logs/rosbag/bag_file.h"

#include <malloc.h>

#include "bag_files.h"
#include "ros1_files.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

TEST(Ros1Bag, lists_the_topics_of_a_long_index) {
  mallopt(M_MMAP_THRESHOLD, 128 * 1024);  // makes reads of freed memory crash
  const TemporaryFolder folder;
  Recording recording;
  for (int i = 0; i < 3000; ++i)
    recording.emplace_back(
        RecordedPose{"/odom_" + std::to_string(i) + std::string(100, 'x'), i, "odom", "base", {}});
  write_ros1_bag(folder.path() / "run.bag", recording);
  const auto topics = open_ros1_bag(folder.path() / "run.bag")->topics();
  ASSERT_EQ(topics.size(), recording.size());
  for (std::size_t i = 0; i < topics.size(); ++i) ASSERT_EQ(topics[i].name, topic_of(recording[i]));
}

}  // namespace
}  // namespace psi_slam
