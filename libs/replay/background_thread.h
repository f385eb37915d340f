// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/resource.h>
#include <unistd.h>

namespace psi_slam {

/// Lets this thread, and those that it will start, give way to the window's where processors are scarce: a
/// window that is late annoys more than a map that is.
inline void give_way() {
  constexpr int kNiceness = 5;
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNiceness);  // Linux: of this thread alone
}

}  // namespace psi_slam
