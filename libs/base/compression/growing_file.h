// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>

struct gzFile_s;

namespace psi_slam {

/// Reads a file that another program is still writing, plain or compressed by gzip.
class GrowingFile {
 public:
  /// Throws UserError if the file cannot be opened.
  explicit GrowingFile(std::filesystem::path path);

  /// Reads up to `size` bytes and returns their number, which is 0 if the file has no more bytes now. Throws
  /// UserError if the file became shorter, is damaged or cannot be read.
  std::size_t read(char* bytes, std::size_t size);

  const std::filesystem::path& path() const { return path_; }

 private:
  void check_size();

  std::filesystem::path path_;
  int descriptor_;  // owned by file_
  std::unique_ptr<gzFile_s, int (*)(gzFile_s*)> file_;
  std::int64_t largest_bytes_ = 0;  // largest number of bytes seen on disk
};

}  // namespace psi_slam
