// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <condition_variable>
#include <cstddef>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include "base/file_tail.h"

namespace psi_slam {

/// A new file that grows while other programs read it. A thread of its own writes it, so that no function
/// except the constructor and close() waits for the disk. What cannot be written, because the disk is full
/// for example, waits in memory and is tried again every second.
class AppendedFile {
 public:
  /// Maximum number of bytes that wait in memory while the file cannot be written.
  static constexpr std::size_t kMostWaitingBytes = std::size_t{1} << 26;

  /// Creates the file. Throws UserError if it exists and `overwrite` is false, and SystemFailure if it cannot
  /// be created.
  AppendedFile(const std::filesystem::path& path, bool overwrite);
  /// Closes the file.
  ~AppendedFile();
  AppendedFile(const AppendedFile&) = delete;
  AppendedFile& operator=(const AppendedFile&) = delete;

  /// Appends bytes as a whole. Returns false, and appends nothing, if more than kMostWaitingBytes would wait.
  bool append(std::string_view bytes);

  /// Tries once to write the rest. Do not call append() afterwards.
  void close();

  /// Why the file could not be written the last time, a sentence without full stop; empty if it was written.
  std::optional<std::string> failure() const;

 private:
  void work();

  FileTail tail_;

  mutable std::mutex mutex_;  ///< protects the members below
  std::condition_variable changed_;
  std::string appended_;           ///< bytes that follow those of tail_
  std::size_t waiting_bytes_ = 0;  ///< bytes that the disk does not have yet
  std::optional<std::string> failure_;
  bool stop_ = false;  ///< the thread ends or has ended

  std::thread thread_;
};

}  // namespace psi_slam
