// SPDX-License-Identifier: BSD-3-Clause
#include "compression/compressed_file.h"

#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

constexpr unsigned kBufferBytes = 256 * 1024;
constexpr std::size_t kMaxBytesPerCall = std::size_t{1} << 30;  // zlib counts bytes as unsigned int

}  // namespace

struct CompressedFile::State {
  fs::path path;
  gzFile file = nullptr;
  std::uintmax_t bytes_on_disk = 0;
  std::optional<UserError> failure;  // met after bytes that were returned

  ~State() {
    if (file != nullptr) gzclose(file);
  }

  /// Reason why zlib returned fewer bytes than requested; empty at the end of the file.
  std::optional<UserError> failure_now() const {
    int code = Z_OK;
    gzerror(file, &code);
    if (code == Z_OK) return std::nullopt;
    if (code == Z_BUF_ERROR)
      return UserError(path.string() + " is cut off: its compressed data are incomplete. Fetch it again");
    if (code == Z_ERRNO) return UserError("cannot read " + path.string() + ": " + std::strerror(errno));
    return UserError(path.string() + " is damaged: its data cannot be decompressed. Fetch it again");
  }
};

CompressedFile::CompressedFile(fs::path path) : state_(std::make_unique<State>()) {
  state_->path = std::move(path);
  std::error_code error;
  const fs::file_status status = fs::status(state_->path, error);
  if (!fs::exists(status)) throw UserError(state_->path.string() + " does not exist, expected a log file");
  if (fs::is_directory(status)) throw UserError(state_->path.string() + " is a folder, expected a log file");
  errno = 0;
  state_->file = gzopen(state_->path.c_str(), "rb");
  if (state_->file == nullptr)
    throw UserError("cannot read " + state_->path.string() + ": " + std::strerror(errno));
  gzbuffer(state_->file, kBufferBytes);
  state_->bytes_on_disk = fs::file_size(state_->path, error);
  if (error) state_->bytes_on_disk = 0;
}

CompressedFile::~CompressedFile() = default;
CompressedFile::CompressedFile(CompressedFile&&) noexcept = default;
CompressedFile& CompressedFile::operator=(CompressedFile&&) noexcept = default;

std::size_t CompressedFile::read(char* bytes, std::size_t size) {
  if (state_->failure) throw UserError(*state_->failure);
  std::size_t done = 0;
  while (done < size) {
    const auto wanted = static_cast<unsigned>(std::min(size - done, kMaxBytesPerCall));
    const int got = gzread(state_->file, bytes + done, wanted);
    if (got > 0) done += static_cast<std::size_t>(got);
    if (got == static_cast<int>(wanted)) continue;
    state_->failure = state_->failure_now();
    break;
  }
  if (done == 0 && state_->failure) throw UserError(*state_->failure);
  return done;
}

const fs::path& CompressedFile::path() const {
  return state_->path;
}

double CompressedFile::progress() const {
  if (gzeof(state_->file) != 0 || state_->bytes_on_disk == 0) return 1;
  const auto read_bytes = static_cast<double>(gzoffset(state_->file));
  return std::clamp(read_bytes / static_cast<double>(state_->bytes_on_disk), 0.0, 1.0);
}

}  // namespace psi_slam
