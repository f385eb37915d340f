// SPDX-License-Identifier: BSD-3-Clause
// Session files; share/doc/sessions.md describes the format. In every version the first 20 bytes are the
// magic word and the version, and the last 64 bytes are the checksum of all bytes before them. A journal (see
// session_journal.h) is read like a session.
#pragma once

#include <filesystem>
#include <vector>

#include "session/session_content.h"
#include "session/session_recording.h"

namespace psi_slam {

/// Whether the file begins with the magic word of sessions or of journals. False if the file is unreadable.
bool is_session_file(const std::filesystem::path& path);

/// Throws UserError if the file, which should be a log, is a session or a journal.
void require_log(const std::filesystem::path& path);

/// Writes the file whole or not at all. Throws SystemFailure if it cannot be written.
void write_session_file(const std::filesystem::path& path, const SessionFacts& facts,
                        const std::vector<Frame>& frames);

/// Reads a session or a journal. Throws UserError, naming the file, if it is neither, is damaged, or has a
/// newer version. Ignores an incomplete chunk at the end of a journal, see SessionRecording::lost_end.
SessionRecording read_session_file(const std::filesystem::path& path);

}  // namespace psi_slam
