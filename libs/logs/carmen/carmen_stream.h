// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "base/compression/byte_source.h"
#include "logs/frames/log_reader.h"

namespace psi_slam {

/// Reads CARMEN lines while they are sent. The first lines decide which lasers are read, where they are
/// mounted, their maximum range, and whether RAWLASER scans get odometry: the lines until `look_over_s`
/// seconds after the first scan, by its time stamps, or until line kLinesOfHead, whichever comes first. If
/// the options name several lasers, the reader waits for all of them, see LookOver. It also reads a named
/// laser that appears later. The function waits for these lines and keeps the latest 16 MB or so of the lines
/// before the first scan. A stream gives the same frames as a file with the same lines if the rest of the
/// file does not change these decisions, and if odometry is at most 100 scans late.
///
/// Skips all malformed lines. Throws UserError as open_carmen_log().
std::unique_ptr<LogReader> open_carmen_stream(std::unique_ptr<ByteSource> stream, const LogOptions& options,
                                              double look_over_s);

}  // namespace psi_slam
