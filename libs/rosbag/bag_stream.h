// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "compression/compressed_file.h"

namespace psi_slam {

/// The bytes of a file with records, in their order, and where one is. Memory grows with what the file holds,
/// never with what one of its lengths claims.
class BagStream {
 public:
  explicit BagStream(const std::filesystem::path& path) : file_(path) {}

  /// The next `size` bytes, valid until the next call. Throws UserError when the file ends before.
  std::string_view read(std::uint64_t size);

  /// Up to `size` bytes: fewer only at the end.
  std::string_view read_up_to(std::uint64_t size);

  void skip(std::uint64_t size);

  std::uint64_t offset() const { return offset_; }
  double progress() const { return file_.progress(); }
  const std::filesystem::path& path() const { return file_.path(); }

  /// "run.bag: byte 4117".
  std::string place_of(std::uint64_t offset) const;

 private:
  CompressedFile file_;
  std::string bytes_;
  std::uint64_t offset_ = 0;
};

/// The bytes of a plain file from `offset` on, counted from its end when negative; none when there are none
/// or more than a summary at a file's end may have.
std::optional<std::string> tail_of_file(const std::filesystem::path& path, std::int64_t offset);

}  // namespace psi_slam
