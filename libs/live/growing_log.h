// SPDX-License-Identifier: BSD-3-Clause
// A log that another program is still recording.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "base/compression/byte_source.h"
#include "live/line_stream.h"
#include "live/live_control.h"
#include "logs/frames/log_format.h"
#include "logs/rosbag/bag_recorder.h"

namespace psi_slam {

/// Returns the format of a log that is being recorded, by its content if it has any yet, otherwise by the
/// name of the file: .bag and .active, .mcap, .db3, .rawlog, and CARMEN for all others; each but .db3 may end
/// in .gz. A folder is that of a ROS 2 bag; it may still be empty. Throws UserError for what cannot be
/// followed: a folder with other files, what is no regular file, compressed SQLite bags, and files compressed
/// by zstd.
LogFormat growing_format(const std::filesystem::path& file);

/// Returns a recorder that lets the reader wait until the user stops or nothing came for `idle_s` seconds;
/// empty: never.
BagRecorder patient_recorder(LiveControl control, std::optional<double> idle_s);

/// Reads a text file, plain or gzipped, from its beginning and waits for more at its end. Throws UserError if
/// the file is unreadable.
std::unique_ptr<LineStream> growing_lines(const std::filesystem::path& file, LiveControl control,
                                          std::optional<double> idle_s);

/// Reads the bytes of any file, plain or gzipped, from its beginning and waits for more at its end. A
/// recorder that has closed the file may still write its last bytes; they are awaited for 10 s. Throws
/// UserError if the file is unreadable.
std::unique_ptr<ByteSource> growing_bytes(const std::filesystem::path& file, BagRecorder recorder);

}  // namespace psi_slam
