// SPDX-License-Identifier: BSD-3-Clause
#include "base/compression/decompressor.h"

#include <bzlib.h>
#include <lz4frame.h>
#include <lzma.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <utility>

namespace psi_slam {
namespace {

using State = Decompressor::State;

/// The caller passes the compressed blocks one by one, because the call that finds damage drops the bytes
/// that it has decompressed.
class ZstdDecompressor : public Decompressor {
 public:
  explicit ZstdDecompressor(int most_window_log) {
    ZSTD_DCtx_setParameter(context_.get(), ZSTD_d_windowLogMax, most_window_log);
  }

  std::size_t wanted() const override { return std::max<std::size_t>(wanted_, 1); }

  Step step(std::string_view& compressed, char* bytes, std::size_t room) override {
    ZSTD_inBuffer in{compressed.data(), compressed.size(), 0};
    ZSTD_outBuffer out{bytes, room, 0};
    wanted_ = ZSTD_decompressStream(context_.get(), &out, &in);
    compressed.remove_prefix(in.pos);
    const bool is_damaged = ZSTD_isError(wanted_) != 0;
    return {out.pos, is_damaged ? State::kDamaged : wanted_ == 0 ? State::kAtEndOfPart : State::kInPart};
  }

 private:
  std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context_{ZSTD_createDCtx(), &ZSTD_freeDCtx};
  std::size_t wanted_ = 1;  // compressed bytes that zstd expects next; 0 at the end of a frame
};

/// The caller passes the compressed blocks one by one, as for zstd.
class Lz4Decompressor : public Decompressor {
 public:
  Lz4Decompressor() {
    LZ4F_dctx* context = nullptr;
    if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) == 0) context_.reset(context);
  }

  std::size_t wanted() const override { return std::max<std::size_t>(wanted_, 1); }

  Step step(std::string_view& compressed, char* bytes, std::size_t room) override {
    if (!context_) return {0, State::kDamaged};
    std::size_t taken = compressed.size();
    wanted_ = LZ4F_decompress(context_.get(), bytes, &room, compressed.data(), &taken, nullptr);
    if (LZ4F_isError(wanted_) != 0) return {0, State::kDamaged};
    compressed.remove_prefix(taken);
    return {room, wanted_ == 0 ? State::kAtEndOfPart : State::kInPart};
  }

 private:
  std::size_t wanted_ = 1;  // compressed bytes that lz4 expects next; 0 at the end of a frame
  std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context_{
      nullptr, &LZ4F_freeDecompressionContext};
};

struct Bzip2 {
  using Stream = bz_stream;
  static bool begin(Stream& stream) { return BZ2_bzDecompressInit(&stream, 0, 0) == BZ_OK; }
  static void end(Stream& stream) { BZ2_bzDecompressEnd(&stream); }
  static void skip_padding(std::string_view&) {}
  static State run(Stream& stream) {
    const int code = BZ2_bzDecompress(&stream);
    return code == BZ_OK ? State::kInPart : code == BZ_STREAM_END ? State::kAtEndOfPart : State::kDamaged;
  }
};

struct Xz {
  using Stream = lzma_stream;
  static constexpr std::uint64_t kMostMemory_bytes = std::uint64_t{1} << 27;  // xz -9 needs half of it
  static bool begin(Stream& stream) { return lzma_stream_decoder(&stream, kMostMemory_bytes, 0) == LZMA_OK; }
  static void end(Stream& stream) { lzma_end(&stream); }
  static void skip_padding(std::string_view& compressed) {
    compressed.remove_prefix(std::min(compressed.find_first_not_of('\0'), compressed.size()));
  }
  static State run(Stream& stream) {
    const lzma_ret code = lzma_code(&stream, LZMA_RUN);
    if (code == LZMA_MEMLIMIT_ERROR) return State::kTooLarge;
    const bool goes_on = code == LZMA_OK || code == LZMA_BUF_ERROR;  // it needs more bytes or more room
    return goes_on ? State::kInPart : code == LZMA_STREAM_END ? State::kAtEndOfPart : State::kDamaged;
  }
};

/// Decompresses with a library whose interface has the form of zlib's. Each part is a stream of its own.
template <class Library>
class StreamDecompressor : public Decompressor {
 public:
  ~StreamDecompressor() override { end(); }

  std::size_t wanted() const override { return std::numeric_limits<std::size_t>::max(); }

  Step step(std::string_view& compressed, char* bytes, std::size_t room) override {
    if (!is_open_) {
      Library::skip_padding(compressed);
      if (compressed.empty()) return {0, State::kAtEndOfPart};
      stream_ = {};
    }
    if (!is_open_ && !(is_open_ = Library::begin(stream_))) return {0, State::kDamaged};
    constexpr std::size_t kMost = std::numeric_limits<unsigned>::max();  // bzip2 counts bytes as unsigned int
    const std::size_t in = std::min(compressed.size(), kMost);
    const std::size_t out = std::min(room, kMost);
    // The libraries do not write through this pointer, although bzip2's interface takes a mutable one.
    stream_.next_in = reinterpret_cast<decltype(stream_.next_in)>(const_cast<char*>(compressed.data()));
    stream_.avail_in = static_cast<decltype(stream_.avail_in)>(in);
    stream_.next_out = reinterpret_cast<decltype(stream_.next_out)>(bytes);
    stream_.avail_out = static_cast<decltype(stream_.avail_out)>(out);
    const State state = Library::run(stream_);
    compressed.remove_prefix(in - stream_.avail_in);
    const std::size_t written = out - stream_.avail_out;
    if (state == State::kAtEndOfPart) end();
    return {written, state};
  }

 private:
  void end() {
    if (std::exchange(is_open_, false)) Library::end(stream_);
  }

  typename Library::Stream stream_{};
  bool is_open_ = false;
};

}  // namespace

std::string_view compression_of(std::string_view head) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kBeginnings{
      {{"\x1F\x8B", "gzip"},
       {"BZh", "bz2"},
       {{"\xFD\x37\x7A\x58\x5A\0", 6}, "xz"},
       {"\x04\x22\x4D\x18", "lz4"},
       {"\x28\xB5\x2F\xFD", "zstd"}}};
  for (const auto& [beginning, name] : kBeginnings)
    if (head.substr(0, beginning.size()) == beginning) return name;
  return {};
}

std::unique_ptr<Decompressor> make_decompressor(std::string_view compression, int most_window_log) {
  if (compression == "bz2") return std::make_unique<StreamDecompressor<Bzip2>>();
  if (compression == "lz4") return std::make_unique<Lz4Decompressor>();
  if (compression == "xz") return std::make_unique<StreamDecompressor<Xz>>();
  if (compression == "zstd") return std::make_unique<ZstdDecompressor>(most_window_log);
  return nullptr;
}

}  // namespace psi_slam
