// SPDX-License-Identifier: BSD-3-Clause
#include "session/journal_chunks.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "base/byte_cursor.h"
#include "base/file_checksum.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr std::string_view kMarker = "psichunk";  // the first bytes of every chunk
constexpr std::size_t kJournalHeadBytes = kJournalMagic.size() + sizeof(std::uint32_t);
constexpr std::size_t kChunkChecksumBytes = 64;
constexpr int kChunkCompression = 3;  // higher levels cost much more time for few bytes

/// An intact chunk of a journal.
struct Chunk {
  std::string_view packed;  ///< see SessionContentWriter
  std::size_t end = 0;      ///< offset in the file of the byte after the chunk
};

/// Returns the chunk at `offset`, or nothing if no intact chunk begins there. The first chunk is at offset 0
/// and includes the head of the file.
std::optional<Chunk> intact_chunk(std::string_view bytes, std::size_t offset) {
  try {
    ByteCursor cursor(bytes.substr(offset));
    if (offset == 0) cursor.take(kJournalHeadBytes);
    if (cursor.take(kMarker.size()) != kMarker) return std::nullopt;
    const std::size_t begin = offset + cursor.offset();
    const auto packed_size = cursor.number<std::uint64_t>();
    cursor.number<std::uint64_t>();
    cursor.take(packed_size);
    const std::size_t end = offset + cursor.offset();
    if (cursor.take(kChunkChecksumBytes) != sha256_of_text(bytes.substr(offset, end - offset)))
      return std::nullopt;
    return Chunk{bytes.substr(begin, end - begin), end + kChunkChecksumBytes};
  } catch (const MalformedBytes&) {  // the bytes end within the chunk
    return std::nullopt;
  }
}

/// Returns whether an intact chunk begins after `offset`.
bool has_later_chunk(std::string_view bytes, std::size_t offset) {
  for (std::size_t at = bytes.find(kMarker, offset + 1); at != std::string_view::npos;
       at = bytes.find(kMarker, at + 1))
    if (intact_chunk(bytes, at)) return true;
  return false;
}

/// Sets the number of scans of the last log, which chunks do not state.
void count_scans(SessionRecording& recording) {
  std::vector<RecordedLog>& logs = recording.facts.logs;
  if (logs.empty()) return;
  logs.back().scans = recording.frames.size();
  for (std::size_t i = 0; i + 1 < logs.size(); ++i) {
    if (logs[i].scans > logs.back().scans) throw MalformedBytes("its logs have more scans than the journal");
    logs.back().scans -= logs[i].scans;
  }
}

}  // namespace

std::string JournalChunks::next(SessionFacts facts, const std::vector<Frame>& frames) {
  // The scans of the last log are those of all frames, so facts that only grew by scans need no repetition.
  if (!facts.logs.empty()) facts.logs.back().scans = 0;
  std::string bytes;
  if (last_facts_.empty()) {
    bytes = kJournalMagic;
    append_number(bytes, kSessionVersion);
  }
  std::string text = facts_text(facts);
  bytes += kMarker;
  bytes += content_.packed(text == last_facts_ ? "" : text, frames, kChunkCompression);
  last_facts_ = std::move(text);
  return bytes += sha256_of_text(bytes);
}

bool is_journal(std::string_view bytes) {
  return bytes.substr(0, kJournalMagic.size()) == kJournalMagic;
}

SessionRecording read_journal(std::string_view bytes, const std::filesystem::path& path) {
  if (bytes.size() < kJournalHeadBytes) throw MalformedBytes("it is cut off within its head");
  const auto version =
      ByteCursor(bytes.substr(kJournalMagic.size(), sizeof(std::uint32_t))).number<std::uint32_t>();
  require_known_version(version, path);
  SessionContentReader content(path, bytes.size());
  SessionRecording recording;
  std::size_t offset = 0;
  while (const auto chunk = intact_chunk(bytes, offset)) {
    ByteCursor packed(chunk->packed);
    content.add(packed, recording);
    offset = chunk->end;
  }
  const std::string where = "the chunk at byte " + std::to_string(offset);
  if (offset == 0 || has_later_chunk(bytes, offset))
    throw MalformedBytes("the checksum of " + where + " does not match");
  if (offset < bytes.size())
    recording.lost_end =
        path.string() + " ends with an incomplete chunk of " + std::to_string(bytes.size() - offset) +
        " bytes, which is ignored: its recording was cut off. The scans of that chunk are lost";
  count_scans(recording);
  return recording;
}

}  // namespace psi_slam
