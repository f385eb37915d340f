// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>

namespace psi_slam {

/// Reads a file once from its beginning, plain or gzipped; its content decides. The constructor throws
/// UserError if the file does not exist, is a folder or is not readable.
class CompressedFile {
 public:
  explicit CompressedFile(std::filesystem::path path);
  ~CompressedFile();
  CompressedFile(CompressedFile&&) noexcept;
  CompressedFile& operator=(CompressedFile&&) noexcept;

  /// Reads the next `size` decompressed bytes and returns their number. It is smaller only at the end and
  /// before damaged or truncated data; then the next call throws UserError.
  std::size_t read(char* bytes, std::size_t size);

  const std::filesystem::path& path() const;

  /// Fraction of the file on disk that has been read, in [0, 1].
  double progress() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace psi_slam
