// SPDX-License-Identifier: BSD-3-Clause
#include "logs/rosbag/growing_database.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>

#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

// Bytes that SQLite locks (https://sqlite.org/lockingv3.html). A program that changes the file has a write
// lock on the shared bytes; one that prepares a change has it on the reserved byte.
constexpr std::int64_t kReservedByte = 0x40000001;
constexpr std::int64_t kSharedBytes = 0x40000002;
constexpr std::int64_t kSharedSize = 510;

}  // namespace

GrowingDatabase::GrowingDatabase(const std::filesystem::path& path)
    : journal_(path.string() + "-journal"),
      file_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)),
      log_(path.string() + "-wal") {
  if (!file_.is_open()) throw UserError("cannot read " + path.string() + ": " + std::strerror(errno));
}

// In a rollback mode the writer locks the shared bytes, writes the counter of changes first of all pages, and
// unlocks at the end. So a writer that began after the check of begin() has changed the counter that was read
// before, or still has its lock. In WAL mode pages of the file change only after their commits were appended
// to the log; and frames are overwritten only after the header of the log.
bool GrowingDatabase::begin() {
  state_ = state_now();
  return !is_writing();
}

bool GrowingDatabase::is_unchanged() {
  return !is_writing() && state_now() == state_;
}

GrowingDatabase::State GrowingDatabase::state_now() {
  State state;
  const ssize_t got = ::pread(file_.number(), state.header.data(), state.header.size(), 0);
  if (got < static_cast<ssize_t>(state.header.size())) state.header = {};
  log_.update();
  state.log = log_.identity();
  return state;
}

bool GrowingDatabase::is_writing() const {
  if (is_locked(kSharedBytes, kSharedSize)) return true;
  // A killed writer leaves a journal that nobody locks: its last change must be undone.
  const bool has_journal = std::ifstream(journal_, std::ios::binary).get() > 0;
  return has_journal && !is_locked(kReservedByte, 1);
}

/// Returns whether a program has a write lock on these bytes.
bool GrowingDatabase::is_locked(std::int64_t offset, std::int64_t size) const {
  struct flock lock = {};
  lock.l_type = F_RDLCK;
  lock.l_whence = SEEK_SET;
  lock.l_start = offset;
  lock.l_len = size;
  return ::fcntl(file_.number(), F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
}

std::size_t GrowingDatabase::read_at(std::uint64_t offset, char* bytes, std::size_t size) {
  if (!log_.is_empty()) {
    const std::uint64_t page = offset / log_.page_bytes() + 1;
    if (log_.read_page(static_cast<std::uint32_t>(page), offset % log_.page_bytes(), bytes, size))
      return size;
  }
  const ssize_t got = ::pread(file_.number(), bytes, size, static_cast<off_t>(offset));
  if (got < 0) throw UserError(std::string("cannot read the bag: ") + std::strerror(errno));
  return static_cast<std::size_t>(got);
}

}  // namespace psi_slam
