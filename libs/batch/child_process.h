// SPDX-License-Identifier: BSD-3-Clause
// Runs another program as a child process and reports its exit, its output, and the time and memory that the
// operating system counted for it.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace psi_slam {

/// Path of a program, followed by its arguments.
using ChildWords = std::vector<std::string>;

struct ChildProcess {
  ChildWords words;
  double time_limit_s = 0;       ///< the child is killed after this time; 0: no limit
  std::function<bool()> stop{};  ///< called a few times a second; if it returns true, the child is killed
};

struct ChildEnd {
  int code = -1;           ///< exit code; -1 if the child did not exit by itself
  int signal = 0;          ///< signal that ended the child; 0: none
  bool over_time = false;  ///< killed at the time limit
  bool stopped = false;    ///< killed because `stop` returned true
  std::string out;         ///< standard output; of a long output, at least the last 16 MiB
  std::string err;         ///< standard error; of a long output, at least the last 64 KiB
  double wall_s = 0;
  double cpu_s = 0;            ///< processor time of all threads, in user and kernel mode
  double peak_memory_mib = 0;  ///< largest resident set size

  /// Reason of the failure: the last line of standard error, or how the child ended. Empty on success.
  std::string failure() const;

  /// failure() without `prefix` at its start, such as the "NAME: " of the program's own messages.
  std::string failure_without(const std::string& prefix) const;
};

/// Runs a program to its end, with empty standard input. The program has its own process group: Ctrl-C
/// reaches only the caller. The program is killed when the calling thread ends. Throws SystemFailure when the
/// program cannot be started.
ChildEnd run_child(const ChildProcess& child);

/// Runs a program as run_child() does. If the program cannot be started, returns a failure with the reason in
/// `err`. Returns nothing if `stop` ended the program.
std::optional<ChildEnd> run_to_end(const ChildWords& words, const std::function<bool()>& stop);

}  // namespace psi_slam
