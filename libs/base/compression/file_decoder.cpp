// SPDX-License-Identifier: BSD-3-Clause
#include "base/compression/file_decoder.h"

#include <zlib.h>

#include <algorithm>
#include <cstdio>
#include <string_view>
#include <utility>
#include <vector>

#include "base/compression/decompressor.h"

namespace psi_slam {
namespace {

constexpr unsigned kGzipBufferBytes = 256 * 1024;
constexpr std::size_t kBlockBytes = std::size_t{128} * 1024;
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

/// Reads a compressed file of one or more parts, such as frames of zstd.
class CompressedFileDecoder : public FileDecoder {
 public:
  CompressedFileDecoder(File file, std::unique_ptr<Decompressor> decompressor)
      : file_(std::move(file)), decompressor_(std::move(decompressor)), block_(kBlockBytes) {}

  std::size_t read(char* bytes, std::size_t size) override {
    std::size_t done = 0;
    while (done < size) {
      if (input_.empty() && !holds_output_ && !take_block()) break;
      const Decompressor::Step step = decompressor_->step(input_, bytes + done, size - done);
      done += step.written;
      state_ = step.state;
      if (state_ == Decompressor::State::kDamaged || state_ == Decompressor::State::kTooLarge) break;
      holds_output_ = done == size && state_ == Decompressor::State::kInPart;
    }
    return done;
  }

  End end() const override {
    if (std::ferror(file_.get()) != 0) return End::kUnreadable;
    if (state_ == Decompressor::State::kDamaged) return End::kDamaged;
    if (state_ == Decompressor::State::kTooLarge) return End::kTooLarge;
    return state_ == Decompressor::State::kInPart ? End::kCutOff : End::kEndOfFile;
  }

  std::uintmax_t bytes_taken() const override { return bytes_taken_; }

 private:
  /// Reads the next compressed bytes. Returns false at the end of the file.
  bool take_block() {
    const std::size_t most = std::min(decompressor_->wanted(), block_.size());
    input_ = {block_.data(), std::fread(block_.data(), 1, most, file_.get())};
    bytes_taken_ += input_.size();
    return !input_.empty();
  }

  File file_;
  std::unique_ptr<Decompressor> decompressor_;
  std::vector<char> block_;
  std::string_view input_;  // the part of block_ that is not decompressed yet
  Decompressor::State state_ = Decompressor::State::kInPart;
  bool holds_output_ = false;  // the decompressor may hold more bytes than the last read() had room for
  std::uintmax_t bytes_taken_ = 0;
};

}  // namespace

std::unique_ptr<FileDecoder> open_decoder(const std::filesystem::path& path) {
  File file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) return nullptr;
  char head[6];
  const std::string_view compression = compression_of({head, std::fread(head, 1, sizeof head, file.get())});
  if (auto decompressor = make_decompressor(compression);
      decompressor && std::fseek(file.get(), 0, SEEK_SET) == 0)
    return std::make_unique<CompressedFileDecoder>(std::move(file), std::move(decompressor));
  const gzFile zipped = gzopen(path.c_str(), "rb");
  return zipped == nullptr ? nullptr : std::make_unique<GzipDecoder>(zipped);
}

}  // namespace psi_slam
