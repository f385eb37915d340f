// SPDX-License-Identifier: BSD-3-Clause
// loops.csv: one row for each match found to close a loop, in the order they were made: between what, where and
// how well it matched, what became of it and why. Lengths are metres, angles radians; `reason` is empty where
// it was accepted.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "psi_slam/mapping_result.h"

namespace psi_slam {

std::string loops_csv(const std::vector<LoopRecord>& loops);

/// Writes `loops_csv` atomically. Throws SystemFailure when it cannot be written.
void write_loops_csv(const std::filesystem::path& path, const std::vector<LoopRecord>& loops);

}  // namespace psi_slam
