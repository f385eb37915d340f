// SPDX-License-Identifier: BSD-3-Clause
#include "logs/rosbag/database_bytes.h"

#include <cstring>

namespace psi_slam {
namespace {

/// Size of the database that SQLite receives. It only has to exceed the number of pages in the header of the
/// database, because the true size may be unknown.
constexpr sqlite3_int64 kSizeForSqlite = sqlite3_int64{1} << 40;

/// The open database, as SQLite holds it.
struct OpenDatabase {
  sqlite3_file base;
  DatabaseBytes* database;
};

int close_database(sqlite3_file* /*file*/) {
  return SQLITE_OK;
}

int read_database(sqlite3_file* file, void* bytes, int size, sqlite3_int64 offset) {
  return reinterpret_cast<OpenDatabase*>(file)->database->read(bytes, size, offset);
}

int refuse_write(sqlite3_file* /*file*/, const void* /*bytes*/, int /*size*/, sqlite3_int64 /*offset*/) {
  return SQLITE_READONLY;
}

int refuse_truncation(sqlite3_file* /*file*/, sqlite3_int64 /*size*/) {
  return SQLITE_READONLY;
}

int size_of_database(sqlite3_file* /*file*/, sqlite3_int64* size) {
  *size = kSizeForSqlite;
  return SQLITE_OK;
}

/// Does nothing, for SQLite's functions that synchronise, lock and unlock a file.
int accept(sqlite3_file* /*file*/, int /*flags*/) {
  return SQLITE_OK;
}

int find_no_lock(sqlite3_file* /*file*/, int* is_locked) {
  *is_locked = 0;
  return SQLITE_OK;
}

int know_no_control(sqlite3_file* /*file*/, int /*operation*/, void* /*argument*/) {
  return SQLITE_NOTFOUND;
}

int sector_bytes(sqlite3_file* /*file*/) {
  return 4096;
}

/// Makes SQLite ignore journals and locks, also for a database in WAL mode.
int properties(sqlite3_file* /*file*/) {
  return SQLITE_IOCAP_IMMUTABLE;
}

int open_database(sqlite3_vfs* vfs, const char* /*name*/, sqlite3_file* file, int flags, int* flags_done) {
  static const sqlite3_io_methods kMethods = [] {
    sqlite3_io_methods methods{};
    methods.iVersion = 1;
    methods.xClose = close_database;
    methods.xRead = read_database;
    methods.xWrite = refuse_write;
    methods.xTruncate = refuse_truncation;
    methods.xSync = accept;
    methods.xFileSize = size_of_database;
    methods.xLock = accept;
    methods.xUnlock = accept;
    methods.xCheckReservedLock = find_no_lock;
    methods.xFileControl = know_no_control;
    methods.xSectorSize = sector_bytes;
    methods.xDeviceCharacteristics = properties;
    return methods;
  }();
  file->pMethods = nullptr;
  if ((flags & SQLITE_OPEN_MAIN_DB) == 0) return SQLITE_CANTOPEN;
  auto* const opened = reinterpret_cast<OpenDatabase*>(file);
  opened->base.pMethods = &kMethods;
  opened->database = static_cast<DatabaseBytes*>(vfs->pAppData);
  if (flags_done != nullptr) *flags_done = SQLITE_OPEN_READONLY;
  return SQLITE_OK;
}

int find_no_other_file(sqlite3_vfs* /*vfs*/, const char* /*name*/, int /*flags*/, int* exists) {
  *exists = 0;
  return SQLITE_OK;
}

int keep_name(sqlite3_vfs* /*vfs*/, const char* name, int room, char* full_name) {
  sqlite3_snprintf(room, full_name, "%s", name);
  return SQLITE_OK;
}

}  // namespace

DatabaseBytes::DatabaseBytes()
    : name_("psi-slam-" + std::to_string(reinterpret_cast<std::uintptr_t>(this))),
      vfs_(*sqlite3_vfs_find(nullptr)) {
  vfs_.zName = name_.c_str();
  vfs_.pAppData = this;
  vfs_.szOsFile = sizeof(OpenDatabase);
  vfs_.xOpen = open_database;
  vfs_.xAccess = find_no_other_file;
  vfs_.xFullPathname = keep_name;
  sqlite3_vfs_register(&vfs_, 0);
}

int DatabaseBytes::read(void* bytes, int size, sqlite3_int64 offset) {
  const auto wanted = static_cast<std::size_t>(size);
  auto* const room = static_cast<char*>(bytes);
  try {
    const std::size_t got = read_at(static_cast<std::uint64_t>(offset), room, wanted);
    if (got == wanted) return SQLITE_OK;
    std::memset(room + got, 0, wanted - got);  // as SQLite asks for the bytes after the end
    return SQLITE_IOERR_SHORT_READ;
  } catch (...) {
    failure_ = std::current_exception();
    return SQLITE_IOERR_READ;
  }
}

}  // namespace psi_slam
