// SPDX-License-Identifier: BSD-3-Clause
// A child process and the pipe that it writes to.
#pragma once

#include <sys/types.h>

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

namespace psi_slam {

/// Throws SystemFailure with what was attempted and the text of the error number.
[[noreturn]] void fail_at(const std::string& attempt, int error);

/// A pipe whose destructor closes both ends. Programs started while it exists do not inherit it.
class Pipe {
 public:
  /// Throws SystemFailure when the system cannot create a pipe.
  Pipe();
  ~Pipe();
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int reading() const { return ends_[0]; }
  int writing() const { return ends_[1]; }
  void close_reading() { close_end(0); }
  void close_writing() { close_end(1); }

  /// Waits for bytes and appends them to `text`. Returns false at the end of the data and after a read error.
  /// Returns true after bytes, and if a signal interrupts the wait.
  bool read_to(std::string& text);

  /// Waits for `size` bytes. Returns false if the data end before, or after a read error.
  bool read_exactly(void* bytes, std::size_t size) const;

 private:
  void close_end(std::size_t end);

  std::array<int, 2> ends_{-1, -1};
};

/// Writes all bytes. Returns false if that is impossible, as to a pipe that nobody reads.
bool write_all(int descriptor, std::string_view bytes);

/// Exit of a process, and the resources that the operating system counted for it.
struct EndedChild {
  int status = 0;  ///< exit status in the format of waitpid()
  double cpu_s = 0;
  double peak_memory_mib = 0;
};

/// A child process. The destructor kills a child that has not been waited for.
class RunningChild {
 public:
  explicit RunningChild(pid_t pid) : pid_(pid) {}
  ~RunningChild();
  RunningChild(const RunningChild&) = delete;
  RunningChild& operator=(const RunningChild&) = delete;

  void kill() const;

  /// Waits for the exit. Throws SystemFailure when the system reports no exit, std::logic_error at a second
  /// call.
  EndedChild wait();

 private:
  pid_t pid_;
};

}  // namespace psi_slam
