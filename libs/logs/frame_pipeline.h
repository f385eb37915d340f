// SPDX-License-Identifier: BSD-3-Clause
// What becomes of the scans of a reader before they are mapped: corrected odometry, combined lasers, the
// robot's own body masked, the motion during the sweep removed, and thinning.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "frames/log_format.h"
#include "frames/log_reader.h"

namespace psi_slam {

/// Throws UserError for options that a log of this format cannot follow. `log` names the log.
void check_options_for(LogFormat format, const std::string& log, const LogOptions& options);

/// Returns the frames of a log for mapping. With `look_over_s`, the log is a stream: its frames wait at most
/// `look_over_s` seconds of the stream while the robot's own body is searched, and sweeps have the direction
/// that options or scans state.
std::unique_ptr<FrameSource> frames_to_map(std::unique_ptr<LogReader> reader, LogFormat format,
                                           const LogOptions& options,
                                           std::optional<double> look_over_s = std::nullopt);

}  // namespace psi_slam
