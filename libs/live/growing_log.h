// SPDX-License-Identifier: BSD-3-Clause
// A log that another program is still recording.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "compression/byte_source.h"
#include "frames/log_format.h"
#include "live/line_stream.h"
#include "live/live_control.h"

namespace psi_slam {

/// Returns the format of a log that is being recorded, by its content if it has any yet, otherwise by the
/// name of the file: .bag and .active, .mcap, .db3, .rawlog, and CARMEN for all others; each may end in .gz.
/// Throws UserError for what cannot be followed: what is no regular file, SQLite bags, and files compressed
/// by zstd.
LogFormat growing_format(const std::filesystem::path& file);

/// Reads a text file, plain or gzipped, from its beginning and waits for more at its end. Throws UserError if
/// the file is unreadable.
std::unique_ptr<LineStream> growing_lines(const std::filesystem::path& file, LiveControl control,
                                          std::optional<double> idle_s);

/// Reads the bytes of any file, plain or gzipped, from its beginning and waits for more at its end, until the
/// user stops or no byte comes for `idle_s` seconds; empty: never. Throws UserError if the file is
/// unreadable.
std::unique_ptr<ByteSource> growing_bytes(const std::filesystem::path& file, LiveControl control,
                                          std::optional<double> idle_s);

}  // namespace psi_slam
