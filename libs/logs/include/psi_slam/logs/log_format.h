// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string_view>

namespace psi_slam {

enum class LogFormat { kCarmen, kMrptRawlog, kRos1Bag, kRos2Sqlite, kRos2Mcap, kRos2Folder };

/// "CARMEN", "MRPT rawlog", "ROS 1 bag", "ROS 2 bag (SQLite)" and so on.
std::string_view name_of(LogFormat format);

/// Whether it is a ROS bag, of whatever kind.
bool is_bag(LogFormat format);

/// Decides by content, plain or gzipped, whatever the file is called. Throws UserError when there is no such
/// file or it is empty, a folder that is no ROS 2 bag, or anything else.
LogFormat detect_log_format(const std::filesystem::path& path);

}  // namespace psi_slam
