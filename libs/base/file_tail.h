// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "base/descriptor.h"

namespace psi_slam {

/// End of a growing file: bytes that wait in memory until the disk has them. Used by one thread.
class FileTail {
 public:
  /// `written_bytes`: number of bytes of the file that the disk has.
  FileTail(std::filesystem::path path, Descriptor file, std::size_t written_bytes);

  void append(std::string_view bytes) { unwritten_ += bytes; }
  std::size_t unwritten_bytes() const { return unwritten_.size(); }
  const Descriptor& file() const { return file_; }

  /// Writes the bytes that wait, and waits for the disk. Throws SystemFailure if that fails. Then the next
  /// call writes all of them from the same byte on, because the system may have dropped bytes that it had
  /// accepted.
  void write();

 private:
  std::filesystem::path path_;
  Descriptor file_;
  std::size_t written_bytes_;
  std::string unwritten_;
};

}  // namespace psi_slam
