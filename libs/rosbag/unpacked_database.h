// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sqlite3.h>

#include <exception>
#include <filesystem>
#include <string>

#include "compression/unpacked_file.h"

namespace psi_slam {

/// Lets SQLite read a compressed database, which is unpacked as far as SQLite reads it. Registers a file
/// system for SQLite (https://sqlite.org/vfs.html) that holds only this database, read-only, under any name.
/// Must outlive the connection.
class UnpackedDatabase {
 public:
  /// Throws UserError as UnpackedFile does.
  explicit UnpackedDatabase(const std::filesystem::path& path);
  ~UnpackedDatabase() { sqlite3_vfs_unregister(&vfs_); }
  UnpackedDatabase(const UnpackedDatabase&) = delete;
  UnpackedDatabase& operator=(const UnpackedDatabase&) = delete;

  /// Name of the file system for sqlite3_open_v2().
  const char* vfs_name() const { return vfs_.zName; }

  /// Throws the error that stopped unpacking while SQLite read the database, if there was one.
  void rethrow_failure() const {
    if (failure_) std::rethrow_exception(failure_);
  }

  /// Unpacks the rest of the file. Throws UserError if it is truncated or damaged.
  void unpack_rest() { file_.unpack_rest(); }

  double progress() const { return file_.progress(); }

  /// Reads bytes for SQLite and returns a code of SQLite.
  int read(void* bytes, int size, sqlite3_int64 offset);

 private:
  UnpackedFile file_;
  std::string name_;
  sqlite3_vfs vfs_;
  std::exception_ptr failure_;
};

}  // namespace psi_slam
