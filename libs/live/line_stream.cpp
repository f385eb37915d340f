// SPDX-License-Identifier: BSD-3-Clause
#include "live/line_stream.h"

#include <string_view>
#include <utility>

namespace psi_slam {
namespace {

constexpr std::size_t kMostLineBytes = std::size_t{4} * 1024 * 1024;  // a longer line is no message

}  // namespace

LineStream::LineStream(std::filesystem::path name, LiveControl control, std::optional<double> idle_s)
    : name_(std::move(name)), control_(std::move(control)), idle_s_(idle_s) {}

std::size_t LineStream::read(char* bytes, std::size_t size) {
  while (taken_ == whole_ && !ended_) wait();
  const std::size_t done = std::string_view(buffer_).substr(0, whole_).copy(bytes, size, taken_);
  taken_ += done;
  return done;
}

void LineStream::wait() {
  if (control_.should_stop()) {
    ended_ = true;
    return;
  }
  buffer_.erase(0, taken_);
  taken_ = whole_ = 0;
  const std::size_t searched = buffer_.size();
  switch (receive(buffer_)) {
    case Received::kBytes:
      last_bytes_ = Clock::now();
      if (const std::size_t end = buffer_.rfind('\n'); end != std::string::npos && end >= searched)
        whole_ = end + 1;
      else if (buffer_.size() > kMostLineBytes)
        end_line();
      break;
    case Received::kLost:
      end_line();
      break;
    case Received::kNothing:
      ended_ = is_idle();
      break;
    case Received::kEnd:
      ended_ = true;
      break;
  }
  if (ended_) whole_ = buffer_.size();
}

/// Ends the incomplete line at the end of the buffer.
void LineStream::end_line() {
  if (!buffer_.empty()) buffer_ += '\n';
  whole_ = buffer_.size();
}

bool LineStream::is_idle() const {
  return idle_s_ && std::chrono::duration<double>(Clock::now() - last_bytes_).count() >= *idle_s_;
}

}  // namespace psi_slam
