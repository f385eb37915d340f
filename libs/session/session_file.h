// SPDX-License-Identifier: BSD-3-Clause
// Sessions as files: share/doc/sessions.md has the format. Whatever version a file has, its first 20 bytes
// say so, and its last 64 are the checksum of all before.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "session/session_recording.h"

namespace psi_slam {

/// The newest version, which is written; all versions up to it are read.
inline constexpr std::uint32_t kSessionVersion = 3;

/// Whether the file begins like a session. False where it cannot be read.
bool is_session_file(const std::filesystem::path& path);

/// Throws SystemFailure when the disk does not take it; then nothing stands there that did not before.
void write_session_file(const std::filesystem::path& path, const SessionFacts& facts,
                        const std::vector<Frame>& frames);

/// Throws UserError, a sentence that names the file, when it is no session, is damaged, or is of a version
/// that this program does not know yet.
SessionRecording read_session_file(const std::filesystem::path& path);

}  // namespace psi_slam
