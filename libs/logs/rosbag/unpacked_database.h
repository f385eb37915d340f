// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "base/compression/unpacked_file.h"
#include "logs/rosbag/database_bytes.h"

namespace psi_slam {

/// Lets SQLite read a compressed database, which is unpacked as far as SQLite reads it.
class UnpackedDatabase : public DatabaseBytes {
 public:
  /// Throws UserError as UnpackedFile does.
  explicit UnpackedDatabase(const std::filesystem::path& path) : file_(path) {}

  /// Unpacks the rest of the file. Throws UserError if it is truncated or damaged.
  void unpack_rest() { file_.unpack_rest(); }

  double progress() const { return file_.progress(); }

 protected:
  std::size_t read_at(std::uint64_t offset, char* bytes, std::size_t size) override {
    return file_.read(offset, bytes, size);
  }

 private:
  UnpackedFile file_;
};

}  // namespace psi_slam
