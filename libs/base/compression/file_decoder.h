// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>

namespace psi_slam {

/// Reads the decompressed bytes of a file in order.
class FileDecoder {
 public:
  /// Reason why read() returned fewer bytes than requested. kUnreadable: errno says why.
  /// kTooLarge: decompression needs more memory than is allowed.
  enum class End { kEndOfFile, kCutOff, kDamaged, kTooLarge, kUnreadable };

  virtual ~FileDecoder() = default;

  /// Reads the next `size` bytes and returns their number. The number is smaller at the end of the file and
  /// before truncated or damaged data; see end(). Do not call it again then.
  virtual std::size_t read(char* bytes, std::size_t size) = 0;

  virtual End end() const = 0;

  /// Number of bytes on disk that have been read.
  virtual std::uintmax_t bytes_taken() const = 0;
};

/// Opens a plain file, or one that is compressed as compression_of() shows. Memory does not
/// depend on the sizes that a compressed file states. Returns null, and errno says why, if the file is not
/// readable.
std::unique_ptr<FileDecoder> open_decoder(const std::filesystem::path& path);

}  // namespace psi_slam
