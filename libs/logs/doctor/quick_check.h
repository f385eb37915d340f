// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "psi_slam/frame.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// Checks the scans of a mapped log for faults that diagnose() calls warnings: wrong units and signs, a
/// mirrored or turned laser, odometry that measures wrong distances, jumps or was corrected by a mapper,
/// jumps of the clock, repeated scans, and few returns. Estimates delay, mount and scale as diagnose() does.
/// Aligns fewer scans for the other checks, so it takes a small part of the time of mapping. Considers the
/// first laser only, and the frames [begin, end) of `log`. Returns one sentence for each fault, with the
/// remedy.
std::vector<std::string> quick_check(const std::vector<Frame>& log, std::size_t begin, std::size_t end,
                                     const LogOptions& options);

}  // namespace psi_slam
