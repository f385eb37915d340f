// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace psi_slam {

/// A file in the data folder of the benchmark, named by the environment variable PSI_SLAM_DATA. Empty if the
/// variable is not set or the file is missing; then tests use `GTEST_SKIP() << kNeedsData`.
inline std::optional<std::filesystem::path> shared_file(const std::string& name) {
  const char* folder = std::getenv("PSI_SLAM_DATA");
  if (folder == nullptr || !std::filesystem::exists(std::filesystem::path(folder) / name))
    return std::nullopt;
  return std::filesystem::path(folder) / name;
}

inline constexpr const char* kNeedsData = "needs the benchmark logs: set PSI_SLAM_DATA to their folder";

}  // namespace psi_slam
