// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>

namespace psi_slam {

/// A file read once from its beginning, plain or gzipped, which its content decides. The constructor throws
/// UserError when there is no such file, it is a folder or it may not be read.
class CompressedFile {
 public:
  explicit CompressedFile(std::filesystem::path path);
  ~CompressedFile();
  CompressedFile(CompressedFile&&) noexcept;
  CompressedFile& operator=(CompressedFile&&) noexcept;

  /// The next `size` bytes after decompression; fewer only at the end, and in front of compressed data that
  /// are damaged or end too early: then the next call throws UserError.
  std::size_t read(char* bytes, std::size_t size);

  const std::filesystem::path& path() const;

  /// The share of the file on disk that has been read, in [0, 1].
  double progress() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace psi_slam
