// SPDX-License-Identifier: BSD-3-Clause
#include "session/session_file.h"

#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

#include "base/atomic_file.h"
#include "base/byte_cursor.h"
#include "base/file_bytes.h"
#include "base/file_checksum.h"
#include "psi_slam/user_error.h"
#include "session/journal_chunks.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMagic = "psi-slam session";
constexpr std::size_t kHeadBytes = kMagic.size() + sizeof(std::uint32_t) + 2 * sizeof(std::uint64_t);
constexpr std::size_t kChecksumBytes = 64;
constexpr int kCompressionLevel = 9;

std::string all_bytes(const fs::path& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored))
    throw UserError(path.string() + " does not exist, expected a session. Check the path");
  if (fs::is_directory(path, ignored))
    throw UserError(path.string() + " is a folder, expected a session. Check the path");
  if (!fs::is_regular_file(path, ignored))
    throw UserError(path.string() +
                    " is a pipe or a device, expected a session. Save its data in a file first");
  try {
    return file_bytes(path);
  } catch (const std::system_error& error) {
    throw UserError("cannot read " + path.string() + ", expected a session: " + error.code().message() +
                    ". Check its permissions and the disk");
  }
}

/// Throws UserError unless all bytes are present and the checksum matches.
void require_whole(const fs::path& path, std::string_view bytes) {
  if (bytes.substr(0, kMagic.size()) != kMagic)
    throw UserError(path.string() +
                    " is not a session of psi-slam, expected a file of --save-session. Choose another file");
  if (bytes.size() < kHeadBytes + kChecksumBytes)
    throw UserError(path.string() + " is cut off: it has only " + std::to_string(bytes.size()) + " bytes. " +
                    kUseACopy);
  const std::size_t end = bytes.size() - kChecksumBytes;
  if (bytes.substr(end) == sha256_of_text(bytes.substr(0, end))) return;
  ByteCursor head(bytes.substr(kMagic.size() + sizeof(std::uint32_t)));
  const std::uint64_t expected = kHeadBytes + head.number<std::uint64_t>() + kChecksumBytes;
  if (bytes.size() < expected)
    throw UserError(path.string() + " is cut off: it has " + std::to_string(bytes.size()) + " of " +
                    std::to_string(expected) + " bytes. " + kUseACopy);
  throw UserError(path.string() + " is damaged: its checksum does not match. " + kUseACopy);
}

SessionRecording read_whole_session(std::string_view bytes, const fs::path& path) {
  require_whole(path, bytes);
  ByteCursor cursor(bytes.substr(kMagic.size()));
  const auto version = cursor.number<std::uint32_t>();
  require_known_version(version, path);
  SessionRecording recording;
  SessionContentReader(path, bytes.size()).add(cursor, recording);
  return recording;
}

}  // namespace

bool is_session_file(const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return false;  // to open a pipe can take for ever
  std::ifstream file(path, std::ios::binary);
  static_assert(kMagic.size() == kJournalMagic.size());
  std::string begin(kMagic.size(), '\0');
  return file.read(begin.data(), static_cast<std::streamsize>(begin.size())) &&
         (begin == kMagic || begin == kJournalMagic);
}

void require_log(const fs::path& path) {
  if (is_session_file(path))
    throw UserError(path.string() + " is a session, not a log. Resume it with psi-slam --resume " +
                    path.string() + " -o DIR");
}

void write_session_file(const fs::path& path, const SessionFacts& facts, const std::vector<Frame>& frames) {
  std::string bytes(kMagic);
  append_number(bytes, kSessionVersion);
  bytes += SessionContentWriter().packed(facts_text(facts), frames, kCompressionLevel);
  bytes += sha256_of_text(bytes);
  write_text_atomically(path, bytes);
}

SessionRecording read_session_file(const fs::path& path) {
  const std::string bytes = all_bytes(path);
  try {
    SessionRecording recording =
        is_journal(bytes) ? read_journal(bytes, path) : read_whole_session(bytes, path);
    require_consistent(recording);
    return recording;
  } catch (const MalformedBytes& error) {
    throw UserError(path.string() + " is damaged: " + error.what() + ". " + kUseACopy);
  }
}

}  // namespace psi_slam
