// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>

#include "frames/log_reader.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// Opens a log of any format with the reader of its format: each frame is a scan of one laser as recorded,
/// and `every_nth_scan` and `sweep_time_s` are not applied. Throws UserError as open_log() does.
std::unique_ptr<LogReader> open_log_reader(const std::filesystem::path& path, const LogOptions& options);

}  // namespace psi_slam
