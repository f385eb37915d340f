// SPDX-License-Identifier: BSD-3-Clause
// Test helpers that write small logs and read them back.
#pragma once

#include <filesystem>
#include <utility>
#include <vector>

#include "psi_slam/open_log.h"
#include "test_files.h"

namespace psi_slam {

inline std::vector<Frame> all_frames(FrameSource& source) {
  std::vector<Frame> frames;
  while (auto frame = source.next()) frames.push_back(std::move(*frame));
  return frames;
}

inline std::vector<Frame> frames_of(const std::filesystem::path& path, const LogOptions& options = {}) {
  return all_frames(*open_log(path, options));
}

}  // namespace psi_slam
