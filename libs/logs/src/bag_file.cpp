// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/logs/bag_file.h"

#include "psi_slam/base/user_error.h"
#include "psi_slam/logs/bag_folder.h"
#include "psi_slam/logs/log_format.h"
#include "psi_slam/logs/mcap_bag.h"
#include "psi_slam/logs/ros1_bag.h"
#include "psi_slam/logs/sqlite_bag.h"

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
