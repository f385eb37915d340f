// SPDX-License-Identifier: BSD-3-Clause
// Session files; share/doc/sessions.md describes the format. In every version the first 20 bytes are the
// magic word and the version, and the last 64 bytes are the checksum of all bytes before them. If Frame gets
// a new member, session_file.cpp must write and read it, with a new kSessionVersion.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "session/session_recording.h"

namespace psi_slam {

/// Version of the files that are written. Files of this and all older versions can be read.
inline constexpr std::uint32_t kSessionVersion = 4;

/// Whether the file begins with the magic word of sessions. False if the file is unreadable.
bool is_session_file(const std::filesystem::path& path);

/// Writes the file whole or not at all. Throws SystemFailure if it cannot be written.
void write_session_file(const std::filesystem::path& path, const SessionFacts& facts,
                        const std::vector<Frame>& frames);

/// Reads a session file. Throws UserError, naming the file, if it is not a session, is damaged, or has a
/// newer version.
SessionRecording read_session_file(const std::filesystem::path& path);

}  // namespace psi_slam
