// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string_view>

namespace psi_slam {

enum class LogFormat { kCarmen, kMrptRawlog };

/// "CARMEN" or "MRPT rawlog".
std::string_view name_of(LogFormat format);

/// Decides by content, plain or gzipped, whatever the file is called. Throws UserError when there is no such
/// file or it is empty, a folder, a ROS bag or anything else.
LogFormat detect_log_format(const std::filesystem::path& path);

}  // namespace psi_slam
