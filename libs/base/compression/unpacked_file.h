// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <vector>

#include "base/compression/compressed_file.h"

namespace psi_slam {

/// Random access to the decompressed bytes of a file. Unpacks the file as far as it is read, into a temporary
/// file in $TMPDIR, by default in /tmp. That file has no name, so the system deletes it when the program
/// ends, even if the program is killed.
class UnpackedFile {
 public:
  /// Throws UserError if the file is unreadable (see CompressedFile) or no temporary file can be created.
  explicit UnpackedFile(const std::filesystem::path& path);

  /// Reads `size` decompressed bytes at `offset` and returns their number, which is smaller only at the end
  /// of the file. Throws UserError if these bytes are truncated or damaged, if the temporary file has no
  /// space, or if the file unpacks to far more than recordings of its size do.
  std::size_t read(std::uint64_t offset, char* bytes, std::size_t size);

  /// Unpacks the rest of the file. Throws UserError as read() does.
  void unpack_rest();

  /// Fraction of the file on disk that has been unpacked, in [0, 1].
  double progress() const { return packed_.progress(); }

 private:
  bool unpack_piece();
  [[noreturn]] void fail_to_unpack() const;

  CompressedFile packed_;
  std::filesystem::path folder_;  // folder of the temporary file
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> unpacked_;
  std::uint64_t unpacked_bytes_ = 0;
  std::vector<char> piece_;
};

}  // namespace psi_slam
