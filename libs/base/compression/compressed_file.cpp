// SPDX-License-Identifier: BSD-3-Clause
#include "base/compression/compressed_file.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

namespace psi_slam {

namespace fs = std::filesystem;

namespace {

/// Size of a regular file in bytes; empty for other files.
std::optional<std::uintmax_t> size_of(const Descriptor& file) {
  struct stat state = {};
  if (::fstat(file.number(), &state) != 0 || !S_ISREG(state.st_mode)) return std::nullopt;
  return static_cast<std::uintmax_t>(state.st_size);
}

}  // namespace

CompressedFile::CompressedFile(fs::path path, const std::string& expected) : path_(std::move(path)) {
  std::error_code error;
  const fs::file_status status = fs::status(path_, error);
  if (!fs::exists(status))
    throw UserError(path_.string() + " does not exist, expected " + expected + ". Check the path");
  if (fs::is_directory(status))
    throw UserError(path_.string() + " is a folder, expected " + expected + ". Name a file");
  if (!fs::is_regular_file(status))
    throw UserError(path_.string() + " is a pipe or a device, expected " + expected +
                    ". Save its data in a file first");
  file_ = Descriptor(::open(path_.c_str(), O_RDONLY | O_CLOEXEC));
  bytes_on_disk_ = size_of(file_).value_or(0);
  errno = 0;
  decoder_ = open_decoder(path_);
  if (!decoder_) throw UserError("cannot read " + path_.string() + ": " + std::strerror(errno));
}

bool CompressedFile::became_shorter() const {
  const auto bytes_now = size_of(file_);
  return bytes_now && *bytes_now < bytes_on_disk_;
}

/// Reason why the decoder returned fewer bytes than requested; empty at the end of the file.
std::optional<UserError> CompressedFile::failure_now() const {
  switch (decoder_->end()) {
    case FileDecoder::End::kEndOfFile:
      if (!became_shorter()) return std::nullopt;
      return UserError(path_.string() +
                       " became shorter while it was read, expected a file that is complete. Fetch it again");
    case FileDecoder::End::kCutOff:
      return UserError(path_.string() + " is cut off: its compressed data are incomplete. Fetch it again");
    case FileDecoder::End::kUnreadable:
      return UserError("cannot read " + path_.string() + ": " + std::strerror(errno));
    case FileDecoder::End::kTooLarge:
      return UserError(path_.string() +
                       " needs more than 128 MiB of memory for decompression. Decompress it with xz first");
    case FileDecoder::End::kDamaged:
      break;
  }
  return UserError(path_.string() + " is damaged: its data cannot be decompressed. Fetch it again");
}

std::size_t CompressedFile::read(char* bytes, std::size_t size) {
  if (failure_) throw UserError(*failure_);
  const std::size_t done = decoder_->read(bytes, size);
  if (done < size) failure_ = failure_now();
  if (done == 0 && failure_) throw UserError(*failure_);
  return done;
}

double CompressedFile::progress() const {
  if (bytes_on_disk_ == 0) return 1;
  const auto read_bytes = static_cast<double>(decoder_->bytes_taken());
  return std::clamp(read_bytes / static_cast<double>(bytes_on_disk_), 0.0, 1.0);
}

}  // namespace psi_slam
