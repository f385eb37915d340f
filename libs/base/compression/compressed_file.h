// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "base/compression/byte_source.h"
#include "base/compression/file_decoder.h"
#include "base/descriptor.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

/// Reads a file once from its beginning, plain or compressed by bzip2, gzip, lz4, xz or zstd. Recognises the
/// compression by the content of the file, not by its name. The constructor throws UserError if the file does
/// not exist, is a folder or is not readable.
class CompressedFile : public ByteSource {
 public:
  /// `expected` names the kind of file in the messages about a missing file and about a folder.
  explicit CompressedFile(std::filesystem::path path, const std::string& expected = "a log file");

  /// Reads the next `size` decompressed bytes and returns their number. The number is smaller than `size`
  /// only at the end of the file and before damaged or truncated data. Throws UserError if such data come
  /// first, or at the end if the file became shorter since it was opened.
  std::size_t read(char* bytes, std::size_t size) override;

  const std::filesystem::path& path() const override { return path_; }

  /// Fraction of the file on disk that has been read, in [0, 1].
  double progress() const override;

 private:
  std::optional<UserError> failure_now() const;
  bool became_shorter() const;

  std::filesystem::path path_;
  Descriptor file_;  // tells the size of the file that is read, also if another file replaces it
  std::unique_ptr<FileDecoder> decoder_;
  std::uintmax_t bytes_on_disk_ = 0;
  std::optional<UserError> failure_;  // error for the next call of read()
};

}  // namespace psi_slam
