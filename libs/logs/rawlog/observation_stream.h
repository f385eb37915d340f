// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "base/compression/byte_source.h"
#include "logs/frames/log_reader.h"
#include "logs/rawlog/object_source.h"

namespace psi_slam {

/// Reads observations of MRPT while sensors send them. The observations until `look_over_s` seconds after the
/// first scan, by their time stamps, but at most 500 scans, decide which lasers are read, and whether there
/// is odometry or a gyroscope. The reader waits for lasers that the options name, see LookOver. It also
/// reads a named laser that appears later. The function waits for these observations, and keeps at most the
/// latest 10,000 of them besides the scans. Otherwise a stream gives the same frames as a rawlog of the same
/// observations.
///
/// Skips invalid observations. Throws UserError as open_rawlog(), but only one of the lasers that log.laser
/// names must have appeared. At its end, the reader throws UserError if only invalid observations came.
std::unique_ptr<LogReader> open_observation_stream(std::unique_ptr<ObjectSource> stream,
                                                   const LogOptions& options, double look_over_s);

/// Reads a rawlog while it is recorded, as open_observation_stream() reads observations. The rawlog ends
/// where the bytes end, also within an object.
std::unique_ptr<LogReader> open_rawlog_stream(std::unique_ptr<ByteSource> recording,
                                              const LogOptions& options, double look_over_s);

}  // namespace psi_slam
