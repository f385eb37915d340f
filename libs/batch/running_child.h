// SPDX-License-Identifier: BSD-3-Clause
// What starting another process and listening to it is put together from.
#pragma once

#include <sys/types.h>

#include <array>
#include <string>

namespace psi_slam {

/// Closes itself, here and in every program that is started meanwhile.
class Pipe {
 public:
  /// Throws SystemFailure when there is none to be had.
  Pipe();
  ~Pipe();
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int reading() const { return ends_[0]; }
  int writing() const { return ends_[1]; }
  void close_reading() { close_end(0); }
  void close_writing() { close_end(1); }

  /// Waits until there is something and appends it. False at the end. A signal is no end.
  bool read_to(std::string& text);

 private:
  void close_end(std::size_t end);

  std::array<int, 2> ends_{-1, -1};
};

/// How a process ended, and what it took by the system's own account.
struct EndedChild {
  int status = 0;  ///< of wait()
  double cpu_s = 0;
  double peak_memory_mib = 0;
};

/// A child of this process, which its scope's end ends if it has not been waited for.
class RunningChild {
 public:
  explicit RunningChild(pid_t pid) : pid_(pid) {}
  ~RunningChild();
  RunningChild(const RunningChild&) = delete;
  RunningChild& operator=(const RunningChild&) = delete;

  void kill() const;

  /// Throws SystemFailure when the system does not tell. To be called once.
  EndedChild wait();

 private:
  pid_t pid_;
};

}  // namespace psi_slam
