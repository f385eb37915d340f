// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "compression/compressed_file.h"

namespace psi_slam {

/// The lines of a text file, plain or gzipped, without their line ends ("\n" or "\r\n"). Throws UserError as
/// CompressedFile does, and on a line of more than 16 MB, which is no text.
class LineReader {
 public:
  explicit LineReader(std::filesystem::path path);

  /// Moves to the next line; false at the end. The view holds until the next call.
  bool next(std::string_view& line);

  /// The same for who only looks ahead: what is wrong with the file ends it, too.
  bool next_readable(std::string_view& line);

  /// The number of the line last read, from 1.
  std::size_t line_number() const { return line_number_; }

  /// Whether the line last read had a line end; only the last line of a file may lack it.
  bool line_was_ended() const { return line_was_ended_; }

  /// "path:line" of the line last read, as editors take it.
  std::string place() const;

  const std::filesystem::path& path() const { return file_.path(); }
  double progress() const { return file_.progress(); }

 private:
  bool fill();

  CompressedFile file_;
  std::vector<char> buffer_;
  std::size_t begin_ = 0;  // the unread bytes of the buffer
  std::size_t end_ = 0;
  std::size_t line_number_ = 0;
  bool line_was_ended_ = true;
};

}  // namespace psi_slam
