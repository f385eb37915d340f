// SPDX-License-Identifier: BSD-3-Clause
// What becomes of the scans of a reader before they are mapped: codes for "no return" removed, corrected
// odometry, combined lasers, the robot's own body masked, the motion during the sweep removed, and thinning.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "logs/frames/log_format.h"
#include "logs/frames/log_reader.h"
#include "logs/frames/max_range_study.h"

namespace psi_slam {

/// Throws UserError for options that a log of this format cannot follow. `log` names the log.
void check_options_for(LogFormat format, const std::string& log, const LogOptions& options);

/// Maximum ranges of the lasers of a log by the readings of the whole log. Reads no point clouds, which hold
/// no codes for "no return" and are large. Throws UserError as open_log_reader() does. A maximum range that
/// the options state replaces that of the log: readings beyond it are not studied.
MaxRanges max_ranges_of_log(const std::filesystem::path& path, const LogOptions& options);

/// Returns the frames of the log of a file for mapping. `max_ranges` yields the result of
/// max_ranges_of_log().
std::unique_ptr<FrameSource> frames_to_map(std::unique_ptr<LogReader> reader, LogFormat format,
                                           const LogOptions& options,
                                           const std::function<MaxRanges()>& max_ranges);

/// Returns the frames of a stream for mapping. At most the first `look_over_s` seconds of the stream are held
/// back to find codes for "no return" and readings of the robot's own body. The order of the beams in a sweep
/// is that stated by the options or the scans.
std::unique_ptr<FrameSource> frames_to_map(std::unique_ptr<LogReader> reader, LogFormat format,
                                           const LogOptions& options, double look_over_s);

}  // namespace psi_slam
