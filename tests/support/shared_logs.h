// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace psi_slam {

/// Path of a file in the folder of benchmark logs, which the environment variable PSI_SLAM_DATA names. Empty
/// if the variable is not set or the file does not exist. Tests then call `GTEST_SKIP() << kNeedsData`.
inline std::optional<std::filesystem::path> shared_file(const std::string& name) {
  const char* folder = std::getenv("PSI_SLAM_DATA");
  if (folder == nullptr || !std::filesystem::exists(std::filesystem::path(folder) / name))
    return std::nullopt;
  return std::filesystem::path(folder) / name;
}

inline constexpr const char* kNeedsData = "needs the benchmark logs: set PSI_SLAM_DATA to their folder";

}  // namespace psi_slam
