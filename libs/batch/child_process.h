// SPDX-License-Identifier: BSD-3-Clause
// Another program run to its end as a process of its own, and what it took: by the system's own account of
// that process, whoever wrote the program.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace psi_slam {

struct ChildProcess {
  std::vector<std::string> words;  ///< the program, with its path, and its arguments
  double time_limit_s = 0;         ///< it is killed after so long; 0: never
  std::function<bool()> stop{};    ///< asked a few times a second; once true, it is killed
};

struct ChildEnd {
  int code = -1;           ///< of its exit; -1 if it did not come to that
  int signal = 0;          ///< that ended it
  bool over_time = false;  ///< the time limit did
  bool stopped = false;    ///< `stop` did
  std::string out;         ///< standard output; the last 16 MiB
  std::string err;         ///< standard error; the last 64 KiB
  double wall_s = 0;
  double cpu_s = 0;            ///< of all its threads, the system's work for it included
  double peak_memory_mib = 0;  ///< the most that was in memory at one time

  /// Why it is no success: its last words, or how it ended; empty when it is one.
  std::string failure() const;
};

/// Its standard input is empty. It stands in a process group of its own, so that Ctrl-C is for the caller
/// alone, and ends with the thread that started it, however that ends. Throws SystemFailure when it cannot be
/// started.
ChildEnd run_child(const ChildProcess& child);

}  // namespace psi_slam
