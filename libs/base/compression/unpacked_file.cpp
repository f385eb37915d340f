// SPDX-License-Identifier: BSD-3-Clause
#include "base/compression/unpacked_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>

namespace psi_slam {
namespace {

constexpr std::size_t kPieceBytes = std::size_t{256} * 1024;
// A file unpacks to at most this number of bytes, or this multiple of its size, so that a small file cannot
// fill the disk. Databases of ROS unpack to less than 20 times their size.
constexpr std::uint64_t kMostBytesOfAnyFile = std::uint64_t{1} << 28;
constexpr std::uint64_t kMostRatio = 64;

std::filesystem::path temporary_folder() {
  const char* const stated = std::getenv("TMPDIR");
  return stated != nullptr && *stated != '\0' ? stated : "/tmp";
}

/// Creates a file that is deleted when it is closed. Returns null, and errno says why, if that fails.
std::FILE* open_nameless_file(const std::filesystem::path& folder) {
  std::string name = (folder / "psi-slam-XXXXXX").string();
  const int descriptor = mkostemp(name.data(), O_CLOEXEC);
  if (descriptor < 0) return nullptr;
  unlink(name.c_str());
  std::FILE* const file = fdopen(descriptor, "w+b");
  if (file == nullptr) {
    close(descriptor);
  } else {
    std::setvbuf(file, nullptr, _IONBF, 0);
  }
  return file;
}

}  // namespace

UnpackedFile::UnpackedFile(const std::filesystem::path& path)
    : packed_(path),
      folder_(temporary_folder()),
      unpacked_(open_nameless_file(folder_), &std::fclose),
      piece_(kPieceBytes) {
  if (!unpacked_) fail_to_unpack();
}

std::size_t UnpackedFile::read(std::uint64_t offset, char* bytes, std::size_t size) {
  while (unpacked_bytes_ < offset + size && unpack_piece()) continue;
  if (offset >= unpacked_bytes_) return 0;
  const auto there = static_cast<std::size_t>(std::min<std::uint64_t>(size, unpacked_bytes_ - offset));
  if (fseeko(unpacked_.get(), static_cast<off_t>(offset), SEEK_SET) != 0 ||
      std::fread(bytes, 1, there, unpacked_.get()) != there)
    fail_to_unpack();
  return there;
}

void UnpackedFile::unpack_rest() {
  while (unpack_piece()) continue;
}

/// Unpacks the next bytes; returns false at the end of the file.
bool UnpackedFile::unpack_piece() {
  const std::size_t got = packed_.read(piece_.data(), piece_.size());
  if (fseeko(unpacked_.get(), static_cast<off_t>(unpacked_bytes_), SEEK_SET) != 0 ||
      std::fwrite(piece_.data(), 1, got, unpacked_.get()) != got)
    fail_to_unpack();
  unpacked_bytes_ += got;
  std::error_code error;
  const std::uint64_t packed_bytes = std::filesystem::file_size(packed_.path(), error);
  const std::uint64_t most =
      std::max(kMostBytesOfAnyFile, kMostRatio * (error ? std::uint64_t{0} : packed_bytes));
  if (unpacked_bytes_ > most)
    throw UserError(packed_.path().string() + " unpacks to more than " + std::to_string(most) +
                    " bytes, which no recording of its size does. Fetch it again");
  return got > 0;
}

void UnpackedFile::fail_to_unpack() const {
  throw UserError("cannot unpack " + packed_.path().string() + " into a temporary file in " +
                  folder_.string() + ": " + std::strerror(errno) +
                  ". Free space there, or set TMPDIR to a folder with more space");
}

}  // namespace psi_slam
