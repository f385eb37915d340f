// SPDX-License-Identifier: BSD-3-Clause
#include "base/compression/growing_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr std::size_t kMostBytesPerCall = std::size_t{1} << 30;  // zlib counts bytes as unsigned int

[[noreturn]] void fail_to_read(const std::filesystem::path& path) {
  throw UserError("cannot read " + path.string() + ": " + std::strerror(errno));
}

}  // namespace

GrowingFile::GrowingFile(std::filesystem::path path)
    : path_(std::move(path)),
      descriptor_(::open(path_.c_str(), O_RDONLY | O_CLOEXEC)),
      file_(nullptr, &gzclose) {
  if (descriptor_ < 0) fail_to_read(path_);
  file_.reset(gzdopen(descriptor_, "rb"));
  if (!file_) {
    ::close(descriptor_);
    fail_to_read(path_);
  }
}

// After gzclearerr(), zlib goes on where the file ended at the last call, also within a compressed block.
std::size_t GrowingFile::read(char* bytes, std::size_t size) {
  gzclearerr(file_.get());
  const int got = gzread(file_.get(), bytes, static_cast<unsigned>(std::min(size, kMostBytesPerCall)));
  if (got > 0) return static_cast<std::size_t>(got);
  int code = Z_OK;
  gzerror(file_.get(), &code);
  if (code == Z_ERRNO) fail_to_read(path_);
  if (code != Z_OK && code != Z_BUF_ERROR)
    throw UserError(path_.string() + " is damaged: it cannot be decompressed. Record it again");
  check_size();
  return 0;
}

void GrowingFile::check_size() {
  struct stat state = {};
  if (::fstat(descriptor_, &state) != 0) return;
  largest_bytes_ = std::max<std::int64_t>(largest_bytes_, ::lseek(descriptor_, 0, SEEK_CUR));
  if (state.st_size < largest_bytes_)
    throw UserError(path_.string() +
                    " became shorter while it was followed, expected a log that grows. Follow the new log");
  largest_bytes_ = state.st_size;
}

}  // namespace psi_slam
