// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/resource.h>
#include <unistd.h>

namespace psi_slam {

/// Priority of a thread beside the other threads of the process.
enum class ThreadPriority {
  kNormal,  ///< the priority of the thread that started it
  kLow,     ///< threads of normal priority run first if they share a processor
};

/// Call it once at the beginning of a thread.
inline void set_priority_of_this_thread(ThreadPriority priority) {
  // A larger difference would let other programs of the robot stop a thread for which others may wait.
  constexpr int kLowNiceness = 2;
  if (priority == ThreadPriority::kNormal) return;
  const auto thread = static_cast<id_t>(gettid());  // on Linux, niceness belongs to a single thread
  setpriority(PRIO_PROCESS, thread, getpriority(PRIO_PROCESS, thread) + kLowNiceness);
}

}  // namespace psi_slam
