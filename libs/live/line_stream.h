// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "base/compression/byte_source.h"
#include "live/live_control.h"

namespace psi_slam {

/// Text that is still being sent. Gives whole lines only: a line that is cut off by a lost connection is
/// ended, and a line that is incomplete when the user ends the stream is dropped. The stream also ends after
/// a stated time without a byte.
class LineStream : public ByteSource {
 public:
  static constexpr std::size_t kMostBytes = std::size_t{64} * 1024;  ///< bytes received at once

  /// `name` is the path in messages. `idle_s`: seconds without a byte after which the stream ends;
  /// empty: never.
  LineStream(std::filesystem::path name, LiveControl control, std::optional<double> idle_s);

  std::size_t read(char* bytes, std::size_t size) final;
  const std::filesystem::path& path() const final { return name_; }
  double progress() const final { return 0; }

 protected:
  enum class Received {
    kBytes,    ///< bytes were appended
    kNothing,  ///< no bytes came for a short time
    kLost,     ///< the sender was lost; the next bytes begin a new line
    kEnd,      ///< the stream has ended
  };

  static constexpr int kWait_ms = 100;  ///< time after which receive() gives up

  /// Waits at most kWait_ms for bytes and appends them to `bytes`. Throws UserError if reading fails.
  virtual Received receive(std::string& bytes) = 0;

  void notify(const std::string& sentence) const { control_.notify(sentence); }

 private:
  using Clock = std::chrono::steady_clock;

  void wait();
  void end_line();
  bool is_idle() const;

  std::filesystem::path name_;
  LiveControl control_;
  std::optional<double> idle_s_;
  Clock::time_point last_bytes_ = Clock::now();
  std::string buffer_;
  std::size_t taken_ = 0;  // bytes of buffer_ that read() has returned
  std::size_t whole_ = 0;  // bytes of buffer_ that form whole lines
  bool ended_ = false;
};

}  // namespace psi_slam
