// SPDX-License-Identifier: BSD-3-Clause
// Writes a file completely or not at all: under a temporary name, which nobody can predict, beside it. The
// file gets its name when the disk holds it.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

#include "base/descriptor.h"

namespace psi_slam {

/// A file that replaces `path` when it is complete.
class AtomicFile {
 public:
  /// Creates the temporary file. Follows no symbolic link in its place. Throws SystemFailure that names
  /// `path` if it cannot be created.
  explicit AtomicFile(std::filesystem::path path);

  /// Removes the temporary file unless it has become `path`.
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Appends bytes. Throws SystemFailure that names `path` if they cannot be written.
  void write(std::string_view bytes);

  /// Name of the temporary file. It ends like `path`: writers can choose a format by the extension.
  const std::filesystem::path& temporary_path() const { return temporary_path_; }

  const Descriptor& descriptor() const { return descriptor_; }

  /// Waits until the disk holds the file and replaces `path` by it. Replaces a symbolic link, and not the
  /// file that it points to. Returns the open file. Throws SystemFailure that names `path`.
  Descriptor move_into_place();

 private:
  std::filesystem::path path_;
  std::filesystem::path temporary_path_;
  Descriptor descriptor_;
};

/// Calls `write(temporary_path)`, then replaces `path` by that file. The temporary file exists and is empty.
/// If `write` throws, the temporary file is removed and `path` stays unchanged. Throws SystemFailure that
/// names `path` if it cannot be written.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary_path)>& write);

/// Writes a text, or bytes, to `path` as write_atomically() does.
void write_text_atomically(const std::filesystem::path& path, std::string_view text);

}  // namespace psi_slam
