// SPDX-License-Identifier: BSD-3-Clause
#include "compression/decompression.h"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>

#include "base/byte_cursor.h"

namespace psi_slam {
namespace {

constexpr std::size_t kFirstBytes = std::size_t{1} << 16;

/// What comes out, with room made as it is needed and never beyond `most` bytes.
class Output {
 public:
  explicit Output(std::uint64_t most) : most_(most) {}

  /// Room behind what is there; none when the most is reached.
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
  throw MalformedBytes("its " + std::string(name) + " data do not decompress");
}

[[noreturn]] void fail_as_too_many(std::uint64_t most) {
  throw MalformedBytes("its data decompress to more than the " + std::to_string(most) + " bytes expected");
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
    if (code == BZ_OK && got == 0 && unread == stream.avail_in) fail("bz2");  // the data end too early
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
    if (hint != 0 && got == 0 && taken == 0) fail("lz4");  // the data end too early
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
    if (hint != 0 && out.pos == 0 && taken == in.pos) fail("zstd");  // the data end too early
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

}  // namespace psi_slam
