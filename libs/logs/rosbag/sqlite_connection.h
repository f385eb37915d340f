// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>

#include "logs/rosbag/bag_file.h"

namespace psi_slam {

/// An error that SQLite reports, with its code.
class SqliteError : public std::runtime_error {
 public:
  SqliteError(int code, const std::string& reason) : std::runtime_error(reason), code_(code) {}
  int code() const { return code_; }

 private:
  int code_;
};

using SqliteStatement = std::unique_ptr<sqlite3_stmt, int (*)(sqlite3_stmt*)>;

/// A read-only connection to the database of a ROS 2 bag.
class SqliteConnection {
 public:
  /// Opens a database. `uri` is its name for sqlite3_open_v2(), `vfs` the file system; null: that of the
  /// computer. Texts and blobs may have at most `most_bytes`. Throws SqliteError.
  SqliteConnection(const std::string& uri, const char* vfs, std::uintmax_t most_bytes);

  /// Throws SqliteError, for example if a table does not exist.
  SqliteStatement prepare(const std::string& query) const;

  /// Goes to the next row and returns false after the last one. Throws SqliteError.
  bool step(const SqliteStatement& statement) const;

  /// Returns the topics by their numbers. Throws SqliteError.
  std::map<std::int64_t, BagTopic> topics() const;

 private:
  [[noreturn]] void fail(int code) const;

  std::unique_ptr<sqlite3, int (*)(sqlite3*)> database_;
};

}  // namespace psi_slam
