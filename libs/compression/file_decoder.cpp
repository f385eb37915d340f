// SPDX-License-Identifier: BSD-3-Clause
#include "compression/file_decoder.h"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <cstdio>
#include <string_view>
#include <utility>
#include <vector>

#include "compression/compression.h"

namespace psi_slam {
namespace {

constexpr unsigned kGzipBufferBytes = 256 * 1024;
constexpr std::size_t kMaxGzipBytesPerCall = std::size_t{1} << 30;  // zlib counts bytes as unsigned int

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

/// Reads a plain or gzipped file.
class GzipDecoder : public FileDecoder {
 public:
  explicit GzipDecoder(gzFile file) : file_(file, &gzclose) { gzbuffer(file, kGzipBufferBytes); }

  std::size_t read(char* bytes, std::size_t size) override {
    std::size_t done = 0;
    while (done < size) {
      const auto wanted = static_cast<unsigned>(std::min(size - done, kMaxGzipBytesPerCall));
      const int got = gzread(file_.get(), bytes + done, wanted);
      if (got > 0) done += static_cast<std::size_t>(got);
      if (got != static_cast<int>(wanted)) break;
    }
    return done;
  }

  End end() const override {
    int code = Z_OK;
    gzerror(file_.get(), &code);
    if (code == Z_OK) return End::kEndOfFile;
    if (code == Z_BUF_ERROR) return End::kCutOff;
    return code == Z_ERRNO ? End::kUnreadable : End::kDamaged;
  }

  std::uintmax_t bytes_taken() const override {
    return static_cast<std::uintmax_t>(std::max<z_off_t>(gzoffset(file_.get()), 0));
  }

 private:
  std::unique_ptr<gzFile_s, int (*)(gzFile)> file_;
};

/// Reads a file of one or more zstd frames. Passes the compressed blocks to zstd one by one, because the
/// call that finds damage drops the bytes that it has decompressed.
class ZstdDecoder : public FileDecoder {
 public:
  explicit ZstdDecoder(File file)
      : file_(std::move(file)), context_(ZSTD_createDCtx(), &ZSTD_freeDCtx), block_(ZSTD_DStreamInSize()) {}

  std::size_t read(char* bytes, std::size_t size) override {
    ZSTD_outBuffer out{bytes, size, 0};
    while (out.pos < size) {
      if (input_.pos == input_.size && !holds_output_ && !take_block()) break;
      wanted_ = ZSTD_decompressStream(context_.get(), &out, &input_);
      if (ZSTD_isError(wanted_) != 0) {
        end_ = End::kDamaged;
        break;
      }
      holds_output_ = out.pos == size && wanted_ != 0;
    }
    return out.pos;
  }

  End end() const override { return std::ferror(file_.get()) != 0 ? End::kUnreadable : end_; }
  std::uintmax_t bytes_taken() const override { return bytes_taken_; }

 private:
  /// Reads the next compressed block. Returns false at the end of the file.
  bool take_block() {
    const bool is_between_frames = wanted_ == 0;
    const std::size_t most = std::clamp<std::size_t>(wanted_, 1, block_.size());
    input_ = {block_.data(), std::fread(block_.data(), 1, most, file_.get()), 0};
    bytes_taken_ += input_.size;
    if (input_.size == 0 && !is_between_frames) end_ = End::kCutOff;
    return input_.size > 0;
  }

  File file_;
  std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context_;
  std::vector<char> block_;
  ZSTD_inBuffer input_{nullptr, 0, 0};
  std::size_t wanted_ = 1;     // compressed bytes that zstd expects next; 0 at the end of a frame
  bool holds_output_ = false;  // zstd may hold more bytes than the last read() had room for
  std::uintmax_t bytes_taken_ = 0;
  End end_ = End::kEndOfFile;
};

}  // namespace

std::unique_ptr<FileDecoder> open_decoder(const std::filesystem::path& path) {
  File file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) return nullptr;
  char head[4];
  const bool starts_like_zstd = is_zstd(std::string_view(head, std::fread(head, 1, sizeof head, file.get())));
  if (starts_like_zstd && std::fseek(file.get(), 0, SEEK_SET) == 0)
    return std::make_unique<ZstdDecoder>(std::move(file));
  const gzFile zipped = gzopen(path.c_str(), "rb");
  return zipped == nullptr ? nullptr : std::make_unique<GzipDecoder>(zipped);
}

}  // namespace psi_slam
