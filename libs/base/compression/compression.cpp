// SPDX-License-Identifier: BSD-3-Clause
#include "base/compression/compression.h"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>

#include "base/byte_cursor.h"
#include "base/compression/decompressor.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr int kMostWindowLog = 26;  // zstd takes as much memory beside the result; 64 MiB are rarely used
constexpr std::size_t kFirstBytes = std::size_t{1} << 16;

/// Decompresses the first part of the data. Throws MalformedBytes if the data end early or decompress to more
/// than `most` bytes.
std::string decompress_part(std::string_view name, std::string_view compressed, std::uint64_t most) {
  const std::unique_ptr<Decompressor> decompressor = make_decompressor(name, kMostWindowLog);
  std::string bytes;
  std::size_t used = 0;
  for (auto state = Decompressor::State::kInPart; state != Decompressor::State::kAtEndOfPart;) {
    if (used == bytes.size())
      bytes.resize(static_cast<std::size_t>(
          std::min(most, std::max<std::uint64_t>(kFirstBytes, 2 * std::uint64_t{used}))));
    const std::size_t room = bytes.size() - used;
    const std::size_t left = compressed.size();
    char beyond = 0;
    const Decompressor::Step done = room > 0 ? decompressor->step(compressed, bytes.data() + used, room)
                                             : decompressor->step(compressed, &beyond, 1);
    state = done.state;
    if (room == 0 && done.written > 0)
      throw MalformedBytes("its data decompress to more than the expected " + std::to_string(most) +
                           " bytes");
    const bool is_incomplete =
        state == Decompressor::State::kInPart && done.written == 0 && compressed.size() == left;
    if (state == Decompressor::State::kDamaged || is_incomplete)
      throw MalformedBytes("its " + std::string(name) + " data cannot be decompressed");
    used += done.written;
  }
  bytes.resize(used);
  return bytes;
}

}  // namespace

std::string decompress_zstd_frame(std::string_view compressed, std::uint64_t most) {
  return decompress_part("zstd", compressed, most);
}

std::string decompress(std::string_view name, std::string_view compressed, std::uint64_t size) {
  if (name != "bz2" && name != "lz4" && name != "zstd")
    throw MalformedBytes("its compression is \"" + std::string(name) + "\", expected bz2, lz4 or zstd");
  std::string bytes = decompress_part(name, compressed, size);
  if (bytes.size() != size)
    throw MalformedBytes("its data decompress to " + std::to_string(bytes.size()) + " bytes, not the " +
                         std::to_string(size) + " expected");
  return bytes;
}

std::string gzipped(const void* bytes, std::size_t count) {
  constexpr int kGzipWindow = 15 + 16;
  constexpr int kMemoryLevel = 8;
  z_stream stream{};
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kGzipWindow, kMemoryLevel,
                   Z_DEFAULT_STRATEGY) != Z_OK)
    throw SystemFailure("cannot compress data: out of memory. Close other programs");
  const std::unique_ptr<z_stream, int (*)(z_stream*)> end(&stream, deflateEnd);

  std::string result;
  std::array<char, 65536> buffer{};
  // zlib does not write through this pointer, although its C interface takes a mutable one.
  stream.next_in = static_cast<Bytef*>(const_cast<void*>(bytes));
  int status = Z_OK;
  while (status != Z_STREAM_END) {
    if (stream.avail_in == 0) {
      stream.avail_in = static_cast<uInt>(std::min<std::size_t>(count, std::numeric_limits<uInt>::max()));
      count -= stream.avail_in;
    }
    stream.next_out = reinterpret_cast<Bytef*>(buffer.data());
    stream.avail_out = static_cast<uInt>(buffer.size());
    status = deflate(&stream, count == 0 ? Z_FINISH : Z_NO_FLUSH);
    result.append(buffer.data(), buffer.size() - stream.avail_out);
  }
  return result;
}

std::string zstd_compressed(std::string_view bytes) {
  constexpr int kLevel = 1;
  std::string room(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t used = ZSTD_compress(room.data(), room.size(), bytes.data(), bytes.size(), kLevel);
  if (ZSTD_isError(used) != 0)
    throw SystemFailure("cannot compress data: out of memory. Close other programs");
  room.resize(used);
  return room;
}

std::uint32_t crc32_of(std::string_view bytes) {
  return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace psi_slam
