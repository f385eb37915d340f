// SPDX-License-Identifier: BSD-3-Clause
// The content that sessions and journals share: facts in JSON, followed by frames, compressed.
// share/doc/sessions.md describes the format.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "session/frame_bytes.h"
#include "session/session_recording.h"

namespace psi_slam {

/// Version of the files that are written. Files of psi-slam 0.1.0, which have version 3, can be read, too.
inline constexpr std::uint32_t kSessionVersion = 4;
inline constexpr std::uint32_t kOldestSessionVersion = 3;

/// Advice that ends the messages about damaged files.
inline constexpr const char* kUseACopy = "Use a copy of it, or map the log again.";

/// Throws UserError if this program does not read this version of the file `path`.
void require_known_version(std::uint32_t version, const std::filesystem::path& path);

/// Throws MalformedBytes if facts and frames of a recording contradict each other.
void require_consistent(const SessionRecording& recording);

/// Returns the facts as a JSON text.
std::string facts_text(const SessionFacts& facts);

/// Packs the content of a file, at once or part by part.
class SessionContentWriter {
 public:
  /// Returns facts_text() and frames, compressed with this level of Zstandard, after the compressed size and
  /// the size, both u64. Empty facts: those of the part before.
  std::string packed(const std::string& facts, const std::vector<Frame>& frames, int level);

 private:
  FrameWriter frames_;
};

/// Unpacks what a SessionContentWriter packed, in the same order.
class SessionContentReader {
 public:
  /// Reads content from the file `path` of this size.
  SessionContentReader(std::filesystem::path path, std::size_t file_bytes);

  /// Replaces the facts of the recording, unless the part has none, and appends its frames. Throws
  /// MalformedBytes, or UserError for malformed edits, if the bytes are damaged, and if all parts together
  /// need far more memory than a session of this size.
  void add(ByteCursor& packed, SessionRecording& recording);

 private:
  /// Counts bytes of memory. Throws MalformedBytes if there are too many.
  void count_memory(std::uint64_t bytes);

  FrameReader frames_;
  std::filesystem::path path_;
  std::uint64_t most_memory_bytes_;
  std::uint64_t memory_bytes_ = 0;
};

}  // namespace psi_slam
