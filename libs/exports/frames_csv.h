// SPDX-License-Identifier: BSD-3-Clause
// frames.csv: one row for each scan of the log, in its order: the three poses, the match, the factor Psi, the
// loops, the time spent. Lengths are metres, angles radians, stamps seconds; `node` and `matcher` are empty where there is
// none.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "psi_slam/mapping_result.h"

namespace psi_slam {

std::string frames_csv(const std::vector<FrameRecord>& frames);

/// Writes `frames_csv` atomically. Throws SystemFailure when it cannot be written.
void write_frames_csv(const std::filesystem::path& path, const std::vector<FrameRecord>& frames);

}  // namespace psi_slam
