// SPDX-License-Identifier: BSD-3-Clause
// Journals: sessions that grow while they are mapped, chunk by chunk. share/doc/sessions.md describes the
// format. Each chunk has a checksum of its own, so a chunk that a crash or a power failure cut off is noticed
// and the chunks before it remain readable.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "session/session_content.h"
#include "session/session_recording.h"

namespace psi_slam {

/// The first bytes of every journal.
inline constexpr std::string_view kJournalMagic = "psi-slam journal";

/// Makes the bytes of a journal.
class JournalChunks {
 public:
  /// Returns the next chunk, with the frames since the chunk before and the facts as of its last frame. The
  /// bytes of the first chunk begin with the head of the file.
  std::string next(SessionFacts facts, const std::vector<Frame>& frames);

 private:
  SessionContentWriter content_;
  std::string last_facts_;  ///< empty before the first chunk
};

/// Whether the bytes of a file begin like a journal.
bool is_journal(std::string_view bytes);

/// Reads the bytes of the journal `path`. Ignores an incomplete chunk at its end, see
/// SessionRecording::lost_end. Throws UserError, or MalformedBytes, if another chunk is damaged or the
/// version is newer.
SessionRecording read_journal(std::string_view bytes, const std::filesystem::path& path);

}  // namespace psi_slam
