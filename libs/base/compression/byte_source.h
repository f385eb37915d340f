// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

namespace psi_slam {

/// Bytes that are read once and in order: those of a file, or a stream that is still being sent.
class ByteSource {
 public:
  virtual ~ByteSource() = default;

  /// Reads up to `size` bytes and returns their number, which is 0 only at the end. Blocks until a stream
  /// sends its next bytes.
  virtual std::size_t read(char* bytes, std::size_t size) = 0;

  /// Path of the file, or name of the stream for messages.
  virtual const std::filesystem::path& path() const = 0;

  /// Fraction of the bytes that have been read, in [0, 1]; 0 for a stream.
  virtual double progress() const = 0;
};

/// Text in memory, and after it the bytes of another source unless that is null.
class TextSource : public ByteSource {
 public:
  /// `path` names the text in messages.
  TextSource(std::shared_ptr<const std::string> text, std::filesystem::path path,
             std::unique_ptr<ByteSource> rest = nullptr)
      : text_(std::move(text)), path_(std::move(path)), rest_(std::move(rest)) {}

  std::size_t read(char* bytes, std::size_t size) override {
    const std::size_t done = text_->copy(bytes, size, taken_);
    taken_ += done;
    return done == 0 && rest_ ? rest_->read(bytes, size) : done;
  }

  const std::filesystem::path& path() const override { return path_; }
  double progress() const override { return 0; }

 private:
  std::shared_ptr<const std::string> text_;
  std::filesystem::path path_;
  std::unique_ptr<ByteSource> rest_;
  std::size_t taken_ = 0;
};

}  // namespace psi_slam
