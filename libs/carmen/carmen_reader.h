// SPDX-License-Identifier: BSD-3-Clause
// CARMEN logs: text, one message a line; '#' starts a comment.
//
// Scans of a laser come from one kind of message. By default this is the front laser's: ROBOTLASER1,
// otherwise FLASER, otherwise RAWLASER1, as far as the first lines of the log have it. Without any of them it
// is the rear laser's (ROBOTLASER2, RLASER, RAWLASER2), and finally RAWLASER3 and RAWLASER4. Messages of
// other kinds are counted and otherwise ignored.
//
// The line of a scan states the odometry at its time, except RAWLASER lines: their odometry is interpolated
// between ODOM lines. FLASER lines state a second pose, which a mapper may have corrected. It is never used.
//
// Malformed lines are skipped if they are few: one line, or at most 1 % of the lines that are needed. More of
// them throw UserError, and so does a truncated last line.
#pragma once

#include <filesystem>
#include <memory>

#include "frames/log_reader.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// Opens a CARMEN log. Throws UserError if a selected laser does not exist.
std::unique_ptr<LogReader> open_carmen_log(const std::filesystem::path& path, const LogOptions& options);

}  // namespace psi_slam
