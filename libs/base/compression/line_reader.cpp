// SPDX-License-Identifier: BSD-3-Clause
#include "base/compression/line_reader.h"

#include <cstring>
#include <utility>

#include "base/compression/compressed_file.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr std::size_t kInitialBytes = std::size_t{256} * 1024;
constexpr std::size_t kMaxLineBytes = std::size_t{16} * 1024 * 1024;

}  // namespace

LineReader::LineReader(std::filesystem::path path)
    : LineReader(std::make_unique<CompressedFile>(std::move(path))) {}

LineReader::LineReader(std::unique_ptr<ByteSource> bytes)
    : bytes_(std::move(bytes)), buffer_(kInitialBytes) {}

bool LineReader::fill() {
  if (begin_ > 0) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
  }
  if (end_ == buffer_.size()) {
    if (buffer_.size() >= kMaxLineBytes) {
      throw UserError(bytes_->path().string() + ":" + std::to_string(line_number_ + 1) +
                      ": the line is longer than 16 MB, expected a text file. Check that the file is a log");
    }
    buffer_.resize(buffer_.size() * 2);
  }
  const std::size_t got = bytes_->read(buffer_.data() + end_, buffer_.size() - end_);
  end_ += got;
  return got > 0;
}

bool LineReader::next(std::string_view& line) {
  std::size_t searched = 0;
  while (true) {
    const char* start = buffer_.data() + begin_;
    const std::size_t unread = end_ - begin_;
    const void* found = unread > searched ? std::memchr(start + searched, '\n', unread - searched) : nullptr;
    if (found == nullptr && fill()) {
      searched = unread;
      continue;
    }
    if (found == nullptr && unread == 0) return false;
    line_was_ended_ = found != nullptr;
    const std::size_t length =
        line_was_ended_ ? static_cast<std::size_t>(static_cast<const char*>(found) - start) : unread;
    line = std::string_view(buffer_.data() + begin_, length);
    begin_ += length + (line_was_ended_ ? 1 : 0);
    ++line_number_;
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return true;
  }
}

bool LineReader::next_readable(std::string_view& line) {
  try {
    return next(line);
  } catch (const UserError&) {
    return false;
  }
}

std::string LineReader::place() const {
  return bytes_->path().string() + ":" + std::to_string(line_number_);
}

}  // namespace psi_slam
