// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>

#include "base/descriptor.h"
#include "logs/rosbag/database_bytes.h"
#include "logs/rosbag/write_ahead_log.h"

namespace psi_slam {

/// Lets SQLite read a database that another program is writing, in any journal mode, without a lock. rosbag2
/// does not wait for locks of others: one that a reader holds for a moment can end the recording. So each
/// reading is checked afterwards, and repeated if the other program wrote meanwhile:
///
///     if (database.begin()) { read with a new connection; if (database.is_unchanged()) use what was read; }
class GrowingDatabase : public DatabaseBytes {
 public:
  /// Throws UserError if the file cannot be opened.
  explicit GrowingDatabase(const std::filesystem::path& path);

  /// Begins a reading. Returns false if the other program is writing now, or did not complete a commit.
  bool begin();

  /// Returns whether all that was read since begin() is of one state of the database.
  bool is_unchanged();

  /// Returns whether the database had no page at begin().
  bool is_empty() const { return state_.header == Header{} && log_.is_empty(); }

 protected:
  std::size_t read_at(std::uint64_t offset, char* bytes, std::size_t size) override;

 private:
  using Header = std::array<char, 40>;  // up to the counter of changes, the first page that is written
  struct State {
    Header header{};
    WriteAheadLog::Identity log;
    bool operator==(const State& other) const { return header == other.header && log == other.log; }
  };

  State state_now();
  bool is_writing() const;
  bool is_locked(std::int64_t offset, std::int64_t size) const;

  std::filesystem::path journal_;
  Descriptor file_;
  WriteAheadLog log_;
  State state_;  // at begin()
};

}  // namespace psi_slam
