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

/// Decompressed bytes. The buffer grows as needed, up to `most` bytes.
class Output {
 public:
  explicit Output(std::uint64_t most) : most_(most) {}

  /// Returns the number of free bytes after the existing ones; 0 if the limit is reached.
  std::size_t make_room() {
    if (used_ == bytes_.size()) {
      const std::uint64_t wanted = std::max<std::uint64_t>(kFirstBytes, 2 * std::uint64_t{used_});
      bytes_.resize(static_cast<std::size_t>(std::min(most_, wanted)));
    }
    return bytes_.size() - used_;
  }

  char* end() { return bytes_.data() + used_; }
  void add(std::size_t size) { used_ += size; }

  std::string take() {
    bytes_.resize(used_);
    return std::move(bytes_);
  }

 private:
  std::uint64_t most_;
  std::string bytes_;
  std::size_t used_ = 0;
};

[[noreturn]] void fail(std::string_view name) {
  throw MalformedBytes("its " + std::string(name) + " data cannot be decompressed");
}

[[noreturn]] void fail_as_too_many(std::uint64_t most) {
  throw MalformedBytes("its data decompress to more than the expected " + std::to_string(most) + " bytes");
}

std::string decompress_bz2(std::string_view compressed, std::uint64_t most) {
  bz_stream stream{};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) fail("bz2");
  const std::unique_ptr<bz_stream, decltype(&BZ2_bzDecompressEnd)> end(&stream, &BZ2_bzDecompressEnd);
  std::string input(compressed);
  stream.next_in = input.data();
  stream.avail_in = static_cast<unsigned>(input.size());
  Output output(most);
  char beyond = 0;
  for (int code = BZ_OK; code != BZ_STREAM_END;) {
    const std::size_t room = std::min<std::size_t>(output.make_room(), std::size_t{1} << 30);
    stream.next_out = room > 0 ? output.end() : &beyond;
    stream.avail_out = room > 0 ? static_cast<unsigned>(room) : 1;
    const unsigned offered = stream.avail_out;
    const unsigned unread = stream.avail_in;
    code = BZ2_bzDecompress(&stream);
    const unsigned got = offered - stream.avail_out;
    if (code != BZ_OK && code != BZ_STREAM_END) fail("bz2");
    if (room == 0 && got > 0) fail_as_too_many(most);
    if (code == BZ_OK && got == 0 && unread == stream.avail_in) fail("bz2");  // the data are incomplete
    if (room > 0) output.add(got);
  }
  return output.take();
}

std::string decompress_lz4(std::string_view compressed, std::uint64_t most) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION)) != 0) fail("lz4");
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(
      raw, &LZ4F_freeDecompressionContext);
  Output output(most);
  char beyond = 0;
  for (std::size_t hint = 1; hint != 0;) {
    const std::size_t room = output.make_room();
    std::size_t got = std::max<std::size_t>(room, 1);
    std::size_t taken = compressed.size();
    hint = LZ4F_decompress(context.get(), room > 0 ? output.end() : &beyond, &got, compressed.data(), &taken,
                           nullptr);
    if (LZ4F_isError(hint) != 0) fail("lz4");
    if (room == 0 && got > 0) fail_as_too_many(most);
    if (hint != 0 && got == 0 && taken == 0) fail("lz4");  // the data are incomplete
    compressed.remove_prefix(taken);
    if (room > 0) output.add(got);
  }
  return output.take();
}

}  // namespace

std::string decompress_zstd_frame(std::string_view compressed, std::uint64_t most) {
  const std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context(ZSTD_createDCtx(), &ZSTD_freeDCtx);
  Output output(most);
  char beyond = 0;
  ZSTD_inBuffer in{compressed.data(), compressed.size(), 0};
  for (std::size_t hint = 1; hint != 0;) {
    const std::size_t room = output.make_room();
    ZSTD_outBuffer out{room > 0 ? output.end() : &beyond, std::max<std::size_t>(room, 1), 0};
    const std::size_t taken = in.pos;
    hint = ZSTD_decompressStream(context.get(), &out, &in);
    if (ZSTD_isError(hint) != 0) fail("zstd");
    if (room == 0 && out.pos > 0) fail_as_too_many(most);
    if (hint != 0 && out.pos == 0 && taken == in.pos) fail("zstd");  // the data are incomplete
    if (room > 0) output.add(out.pos);
  }
  return output.take();
}

bool is_known_compression(std::string_view name) {
  return name == "bz2" || name == "lz4" || name == "zstd";
}

bool is_zstd(std::string_view bytes) {
  return bytes.substr(0, 4) == "\x28\xB5\x2F\xFD";
}

std::string decompress(std::string_view name, std::string_view compressed, std::uint64_t size) {
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
    throw SystemFailure("cannot compress data: out of memory");
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
