// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Opens logs of every format.
#pragma once

#include <filesystem>
#include <memory>

#include "psi_slam/frame_source.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// Opens a CARMEN log, an MRPT rawlog or a ROS bag. Detects the format from the content of the file. Throws
/// UserError if the file cannot be opened or has none of these formats, or if an option is invalid. A log
/// without the selected scans or their odometry causes UserError here or in FrameSource::next().
std::unique_ptr<FrameSource> open_log(const std::filesystem::path& path, const LogOptions& options = {});

}  // namespace psi_slam
