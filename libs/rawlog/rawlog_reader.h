// SPDX-License-Identifier: BSD-3-Clause
// MRPT rawlogs, plain or gzipped, in both common forms:
//
// - Actions and sensory frames. Odometry is the sum of the increments of the actions. Every scan of a sensory
//   frame has the odometry of that frame.
// - Single observations, in sensory frames or not. Odometry is absolute, in its own observations, and is
//   interpolated at each scan's time.
//
// The kind of odometry that appears first is used; the other is ignored. By default scans come from the first
// laser in the log. Time stamps, ticks of 100 ns since 1601, become Unix time rounded to the nearest
// microsecond.
#pragma once

#include <filesystem>
#include <memory>

#include "frames/log_reader.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// Opens a rawlog and reads until a laser and odometry have appeared. Throws UserError if one is missing.
std::unique_ptr<LogReader> open_rawlog(const std::filesystem::path& path, const LogOptions& options);

}  // namespace psi_slam
