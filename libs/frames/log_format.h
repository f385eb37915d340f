// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace psi_slam {

enum class LogFormat { kCarmen, kMrptRawlog, kRos1Bag, kRos2Sqlite, kRos2Mcap, kRos2Folder };

/// "CARMEN", "MRPT rawlog", "ROS 1 bag", "ROS 2 bag (SQLite)" and so on.
std::string_view name_of(LogFormat format);

/// Whether it is a ROS bag, of whatever kind.
bool is_bag(LogFormat format);

/// Decides by content, plain or gzipped, whatever the file is called. Throws UserError when there is no such
/// file or it is empty, a folder that is no ROS 2 bag, or anything else.
LogFormat detect_log_format(const std::filesystem::path& path);

/// The files of a ROS 2 bag's folder in their order: what its metadata.yaml lists or, where the recorder was
/// killed before it wrote one, its .db3 and .mcap files by the numbers in their names. Empty when the folder
/// has neither.
std::vector<std::filesystem::path> files_of_bag_folder(const std::filesystem::path& folder);

}  // namespace psi_slam
