// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/compression/byte_source.h"

namespace psi_slam {

/// Reads the lines of a plain or compressed text file, or of a stream, without their line ends ("\n" or
/// "\r\n"). Throws UserError as CompressedFile does, and for a line of 16 MiB or more.
class LineReader {
 public:
  explicit LineReader(std::filesystem::path path);
  explicit LineReader(std::unique_ptr<ByteSource> bytes);

  /// Reads the next line; returns false at the end of the file. The view is valid until the next call.
  bool next(std::string_view& line);

  /// Reads the next line as next() does, but treats a read error as the end of the file. For looking ahead.
  bool next_readable(std::string_view& line);

  /// Number of the last line read, from 1.
  std::size_t line_number() const { return line_number_; }

  /// Returns whether the last line read had a line end. Only the last line of a file can lack a line end.
  bool line_was_ended() const { return line_was_ended_; }

  /// Place of the last line read: "path:line".
  std::string place() const;

  const std::filesystem::path& path() const { return bytes_->path(); }
  double progress() const { return bytes_->progress(); }

 private:
  bool fill();

  std::unique_ptr<ByteSource> bytes_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0;  // unread bytes of the buffer: from begin_ to end_
  std::size_t end_ = 0;
  std::size_t line_number_ = 0;
  bool line_was_ended_ = true;
};

}  // namespace psi_slam
