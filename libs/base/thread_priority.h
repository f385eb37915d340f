// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace psi_slam {

/// Priority of a thread beside the other threads of the process.
enum class ThreadPriority {
  kNormal,  ///< the priority of the thread that started it
  kLow,     ///< threads of normal priority run first if they share a processor
};

/// Call it once at the beginning of a thread.
void set_priority_of_this_thread(ThreadPriority priority);

}  // namespace psi_slam
