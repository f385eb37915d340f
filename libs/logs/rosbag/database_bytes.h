// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sqlite3.h>

#include <cstddef>
#include <cstdint>
#include <exception>
#include <string>

namespace psi_slam {

/// Lets SQLite read a database whose bytes a derived class supplies. Registers a file system for SQLite
/// (https://sqlite.org/vfs.html) that holds only this database, read-only, under any name. SQLite takes no
/// locks and looks for no journals there. Must outlive the connection.
class DatabaseBytes {
 public:
  DatabaseBytes();
  virtual ~DatabaseBytes() { sqlite3_vfs_unregister(&vfs_); }
  DatabaseBytes(const DatabaseBytes&) = delete;
  DatabaseBytes& operator=(const DatabaseBytes&) = delete;

  /// Name of the file system for sqlite3_open_v2().
  const char* vfs_name() const { return vfs_.zName; }

  /// Throws the error that stopped read_at() while SQLite read the database, if there was one.
  void rethrow_failure() const {
    if (failure_) std::rethrow_exception(failure_);
  }

  /// Reads bytes for SQLite and returns a code of SQLite.
  int read(void* bytes, int size, sqlite3_int64 offset);

 protected:
  /// Reads `size` bytes at `offset` and returns their number, which is smaller only at the end.
  virtual std::size_t read_at(std::uint64_t offset, char* bytes, std::size_t size) = 0;

 private:
  std::string name_;
  sqlite3_vfs vfs_;
  std::exception_ptr failure_;
};

}  // namespace psi_slam
