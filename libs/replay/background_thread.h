// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/resource.h>
#include <unistd.h>

namespace psi_slam {

/// Lowers the priority of the calling thread and of threads that it starts later, so that the window's thread
/// runs first.
inline void lower_thread_priority() {
  constexpr int kNiceness = 5;
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNiceness);  // on Linux, affects one thread only
}

}  // namespace psi_slam
