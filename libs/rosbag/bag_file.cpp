// SPDX-License-Identifier: BSD-3-Clause
#include "rosbag/bag_file.h"

#include "psi_slam/user_error.h"
#include "rosbag/bag_folder.h"
#include "frames/log_format.h"
#include "rosbag/mcap_bag.h"
#include "rosbag/ros1_bag.h"
#include "rosbag/sqlite_bag.h"

namespace psi_slam {

std::string ros1_type_name(std::string_view type) {
  constexpr std::string_view kMiddle = "/msg/";
  std::string name(type);
  if (const std::size_t middle = name.find(kMiddle); middle != std::string::npos)
    name.replace(middle, kMiddle.size(), "/");
  return name;
}

std::unique_ptr<BagFile> open_bag(const std::filesystem::path& path) {
  switch (detect_log_format(path)) {
    case LogFormat::kRos1Bag:
      return std::make_unique<Ros1Bag>(path);
    case LogFormat::kRos2Sqlite:
      return std::make_unique<SqliteBag>(path);
    case LogFormat::kRos2Mcap:
      return std::make_unique<McapBag>(path);
    case LogFormat::kRos2Folder:
      return std::make_unique<BagFolder>(files_of_bag_folder(path));
    default:
      throw UserError(path.string() + " is no ROS bag");
  }
}

}  // namespace psi_slam
