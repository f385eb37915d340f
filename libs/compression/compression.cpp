// SPDX-License-Identifier: BSD-3-Clause
#include "compression/compression.h"

#include <bzlib.h>
#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <limits>
#include <memory>

#include "base/byte_cursor.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr std::size_t kFirstBytes = std::size_t{1} << 16;

[[noreturn]] void fail(std::string_view name) {
  throw MalformedBytes("its " + std::string(name) + " data cannot be decompressed");
}

/// Result of one step of a decompression.
struct Step {
  std::size_t written = 0;
  std::size_t taken = 0;  ///< compressed bytes consumed
  bool at_end = false;
};

/// Decompresses data: calls `step(bytes, room)`, which writes up to `room` bytes, until the end of the data.
/// Throws MalformedBytes if the data end early or decompress to more than `most` bytes.
template <class TakeStep>
std::string decompressed(std::string_view name, std::uint64_t most, const TakeStep& step) {
  std::string bytes;
  std::size_t used = 0;
  for (Step done; !done.at_end; used += done.written) {
    if (used == bytes.size())
      bytes.resize(static_cast<std::size_t>(
          std::min(most, std::max<std::uint64_t>(kFirstBytes, 2 * std::uint64_t{used}))));
    const std::size_t room = bytes.size() - used;
    char beyond = 0;
    done = room > 0 ? step(bytes.data() + used, room) : step(&beyond, 1);
    if (room == 0 && done.written > 0)
      throw MalformedBytes("its data decompress to more than the expected " + std::to_string(most) +
                           " bytes");
    if (!done.at_end && done.written == 0 && done.taken == 0) fail(name);  // the data are incomplete
  }
  bytes.resize(used);
  return bytes;
}

std::string decompress_bz2(std::string_view compressed, std::uint64_t most) {
  bz_stream stream{};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) fail("bz2");
  const std::unique_ptr<bz_stream, decltype(&BZ2_bzDecompressEnd)> end(&stream, &BZ2_bzDecompressEnd);
  std::string input(compressed);
  stream.next_in = input.data();
  stream.avail_in = static_cast<unsigned>(input.size());
  return decompressed("bz2", most, [&](char* bytes, std::size_t room) -> Step {
    stream.next_out = bytes;
    stream.avail_out = static_cast<unsigned>(std::min(room, std::size_t{1} << 30));
    const bz_stream before = stream;
    const int code = BZ2_bzDecompress(&stream);
    if (code != BZ_OK && code != BZ_STREAM_END) fail("bz2");
    return {before.avail_out - stream.avail_out, before.avail_in - stream.avail_in, code == BZ_STREAM_END};
  });
}

std::string decompress_lz4(std::string_view compressed, std::uint64_t most) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION)) != 0) fail("lz4");
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      raw, &LZ4F_freeDecompressionContext);
  return decompressed("lz4", most, [&](char* bytes, std::size_t room) -> Step {
    std::size_t taken = compressed.size();
    const std::size_t hint = LZ4F_decompress(context.get(), bytes, &room, compressed.data(), &taken, nullptr);
    if (LZ4F_isError(hint) != 0) fail("lz4");
    compressed.remove_prefix(taken);
    return {room, taken, hint == 0};
  });
}

}  // namespace

std::string decompress_zstd_frame(std::string_view compressed, std::uint64_t most) {
  constexpr int kMostWindowLog = 26;  // zstd takes as much memory beside the result; 64 MiB are rarely used
  const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(ZSTD_createDCtx(), &ZSTD_freeDCtx);
  if (ZSTD_isError(ZSTD_DCtx_setParameter(context.get(), ZSTD_d_windowLogMax, kMostWindowLog)) != 0)
    fail("zstd");
  ZSTD_inBuffer in{compressed.data(), compressed.size(), 0};
  return decompressed("zstd", most, [&](char* bytes, std::size_t room) -> Step {
    ZSTD_outBuffer out{bytes, room, 0};
    const std::size_t before = in.pos;
    const std::size_t hint = ZSTD_decompressStream(context.get(), &out, &in);
    if (ZSTD_isError(hint) != 0) fail("zstd");
    return {out.pos, in.pos - before, hint == 0};
  });
}

bool is_zstd(std::string_view bytes) {
  return bytes.substr(0, 4) == "\x28\xB5\x2F\xFD";
}

std::string decompress(std::string_view name, std::string_view compressed, std::uint64_t size) {
  if (name != "bz2" && name != "lz4" && name != "zstd")
    throw MalformedBytes("its compression is \"" + std::string(name) + "\", expected bz2, lz4 or zstd");
  std::string bytes = name == "bz2"   ? decompress_bz2(compressed, size)
                      : name == "lz4" ? decompress_lz4(compressed, size)
                                      : decompress_zstd_frame(compressed, size);
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

}  // namespace psi_slam
