// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace psi_slam {

enum class LogFormat { kCarmen, kMrptRawlog, kRos1Bag, kRos2Sqlite, kRos2Mcap, kRos2Folder };

/// Name for messages: "CARMEN", "MRPT rawlog", "ROS 1 bag", "ROS 2 bag (SQLite)" and so on.
std::string_view name_of(LogFormat format);

/// Returns whether the format is one of the ROS bags.
bool is_bag(LogFormat format);

/// Detects the format by the content of the file, plain or compressed; its name does not matter. Throws
/// UserError if the file does not exist, is empty, is a folder without a ROS 2 bag, or has none of the
/// formats; see likely_content().
LogFormat detect_log_format(const std::filesystem::path& path);

/// Files in the folder of a ROS 2 bag, in the order of its metadata.yaml. Without metadata.yaml, which a
/// killed recorder does not write: numbered_bag_files(). Empty if the folder has no such files. Throws
/// UserError if metadata.yaml is damaged.
std::vector<std::filesystem::path> files_of_bag_folder(const std::filesystem::path& folder);

/// The .db3 and .mcap files in a folder, in the order of the numbers in their names. Either kind may be
/// compressed by zstd (.db3.zstd). An unpacked file takes precedence over the compressed one.
std::vector<std::filesystem::path> numbered_bag_files(const std::filesystem::path& folder);

/// Orders bag files by the numbers in their names: "run_2.db3" before "run_10.db3". A compressed file is
/// equal to the unpacked one.
bool is_earlier_bag_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// Returns a path without the ending that zstd programs add: "run_0.db3" for "run_0.db3.zstd".
std::filesystem::path without_zstd(std::filesystem::path path);

}  // namespace psi_slam
