// SPDX-License-Identifier: BSD-3-Clause
#include "compression/compressed_file.h"

#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

constexpr unsigned kBufferBytes = 256 * 1024;
constexpr std::size_t kMaxBytesPerCall = std::size_t{1} << 30;  // zlib counts bytes as unsigned int

}  // namespace

CompressedFile::CompressedFile(fs::path path, const std::string& expected)
    : path_(std::move(path)), file_(nullptr, gzclose) {
  std::error_code error;
  const fs::file_status status = fs::status(path_, error);
  if (!fs::exists(status))
    throw UserError(path_.string() + " does not exist, expected " + expected + ". Check the path");
  if (fs::is_directory(status))
    throw UserError(path_.string() + " is a folder, expected " + expected + ". Name a file");
  errno = 0;
  file_.reset(gzopen(path_.c_str(), "rb"));
  if (!file_) throw UserError("cannot read " + path_.string() + ": " + std::strerror(errno));
  gzbuffer(file_.get(), kBufferBytes);
  bytes_on_disk_ = fs::file_size(path_, error);
  if (error) bytes_on_disk_ = 0;
}

/// Reason why zlib returned fewer bytes than requested; empty at the end of the file.
std::optional<UserError> CompressedFile::failure_now() const {
  int code = Z_OK;
  gzerror(file_.get(), &code);
  if (code == Z_OK) return std::nullopt;
  if (code == Z_BUF_ERROR)
    return UserError(path_.string() + " is cut off: its compressed data are incomplete. Fetch it again");
  if (code == Z_ERRNO) return UserError("cannot read " + path_.string() + ": " + std::strerror(errno));
  return UserError(path_.string() + " is damaged: its data cannot be decompressed. Fetch it again");
}

std::size_t CompressedFile::read(char* bytes, std::size_t size) {
  if (failure_) throw UserError(*failure_);
  std::size_t done = 0;
  while (done < size) {
    const auto wanted = static_cast<unsigned>(std::min(size - done, kMaxBytesPerCall));
    const int got = gzread(file_.get(), bytes + done, wanted);
    if (got > 0) done += static_cast<std::size_t>(got);
    if (got == static_cast<int>(wanted)) continue;
    failure_ = failure_now();
    break;
  }
  if (done == 0 && failure_) throw UserError(*failure_);
  return done;
}

double CompressedFile::progress() const {
  if (gzeof(file_.get()) != 0 || bytes_on_disk_ == 0) return 1;
  const auto read_bytes = static_cast<double>(gzoffset(file_.get()));
  return std::clamp(read_bytes / static_cast<double>(bytes_on_disk_), 0.0, 1.0);
}

}  // namespace psi_slam
