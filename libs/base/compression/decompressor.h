// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <string_view>

namespace psi_slam {

/// Decompresses data piece by piece. The data may consist of several parts, one after the other, such as
/// frames of zstd.
class Decompressor {
 public:
  /// kTooLarge: decompression needs more memory than is allowed.
  enum class State { kInPart, kAtEndOfPart, kDamaged, kTooLarge };

  /// Result of step().
  struct Step {
    std::size_t written = 0;  ///< number of decompressed bytes, also before damage
    State state = State::kInPart;
  };

  virtual ~Decompressor() = default;

  /// Maximum number of compressed bytes to pass to the next step(). With more bytes, damage could lose more
  /// than the last block before it.
  virtual std::size_t wanted() const = 0;

  /// Decompresses the beginning of `compressed`, which it removes, to at most `room` bytes. If it fills the
  /// room, it may hold more bytes, which the next call writes, also without compressed bytes.
  virtual Step step(std::string_view& compressed, char* bytes, std::size_t room) = 0;
};

/// Returns the compression of a file by its first six bytes: "bz2", "gzip", "lz4", "xz" or "zstd"; empty for
/// other files.
std::string_view compression_of(std::string_view head);

/// Returns a decompressor for a compression named as by compression_of(), except gzip. Returns null for any
/// other name. Decompression needs at most 128 MiB for xz, 2 to the power of `most_window_log` bytes for
/// zstd, and 20 MiB for the others, whatever sizes the data state.
std::unique_ptr<Decompressor> make_decompressor(std::string_view compression, int most_window_log = 27);

}  // namespace psi_slam
