// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "base/compression/byte_source.h"

namespace psi_slam {

/// Reads a stream in a thread of its own, until it ends or the object is destroyed.
class ReadingThread {
 public:
  /// `stop` ends the stream.
  ReadingThread(std::unique_ptr<ByteSource> stream, std::atomic<bool>& stop)
      : stop_(stop), thread_([this, stream = std::move(stream)] {
          std::array<char, 7> bytes{};
          while (const std::size_t size = stream->read(bytes.data(), bytes.size())) {
            const std::lock_guard lock(mutex_);
            text_.append(bytes.data(), size);
          }
        }) {}
  ~ReadingThread() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }
  ReadingThread(const ReadingThread&) = delete;
  ReadingThread& operator=(const ReadingThread&) = delete;

  std::string text() {
    const std::lock_guard lock(mutex_);
    return text_;
  }
  /// Returns all text after the stream has ended.
  std::string rest() {
    thread_.join();
    return text_;
  }

 private:
  std::atomic<bool>& stop_;
  std::mutex mutex_;
  std::string text_;
  std::thread thread_;
};

}  // namespace psi_slam
