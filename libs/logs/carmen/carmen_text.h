// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include "base/compression/line_reader.h"

namespace psi_slam {

/// CARMEN lines that are looked over before the first scan is read, as often as needed: those of a whole log,
/// or the first lines of a stream.
class CarmenText {
 public:
  /// Lines of a file, which converts implicitly.
  CarmenText(std::filesystem::path file) : path_(std::move(file)) {}

  /// First lines of the stream `name`.
  CarmenText(std::filesystem::path name, std::shared_ptr<const std::string> first_lines)
      : path_(std::move(name)), first_lines_(std::move(first_lines)) {}

  /// Returns a reader at the first line. Throws UserError if the file is unreadable.
  LineReader lines() const {
    return first_lines_ ? LineReader(std::make_unique<TextSource>(first_lines_, path_)) : LineReader(path_);
  }

  bool is_stream() const { return first_lines_ != nullptr; }

  /// Path of the file, or name of the stream.
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  std::shared_ptr<const std::string> first_lines_;  // null for a file
};

}  // namespace psi_slam
