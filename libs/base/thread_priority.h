// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <linux/sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdint>

namespace psi_slam {

/// Priority of a thread beside the other threads of the process.
enum class ThreadPriority {
  kNormal,  ///< the priority of the thread that started it
  kLow,     ///< threads of normal priority run first if they share a processor
};

/// Argument of Linux's sched_setattr(2), which older C libraries do not declare.
struct SchedulingAttributes {
  std::uint32_t size = sizeof(SchedulingAttributes);
  std::uint32_t policy = 0;
  std::uint64_t flags = 0;
  std::int32_t niceness = 0;
  std::uint32_t priority = 0;
  std::uint64_t slice_ns = 0;
  std::uint64_t deadline_ns = 0;
  std::uint64_t period_ns = 0;
};

/// Call it once at the beginning of a thread.
inline void set_priority_of_this_thread(ThreadPriority priority) {
  // A larger difference would let other programs of the robot stop a thread for which others may wait.
  constexpr int kLowNiceness = 2;
  // Since Linux 6.12, a thread that wakes up interrupts another at once only if that one has asked for a
  // longer slice of time. Otherwise it waits until the slice ends, some milliseconds later. The slice does
  // not change the thread's share of the processor. Earlier kernels ignore it.
  constexpr std::uint64_t kLongSlice_ns = 20'000'000;
  if (priority == ThreadPriority::kNormal) return;
  const auto thread = static_cast<id_t>(gettid());  // on Linux, niceness belongs to a single thread
  SchedulingAttributes attributes;
  attributes.flags = SCHED_FLAG_KEEP_POLICY;
  attributes.niceness = getpriority(PRIO_PROCESS, thread) + kLowNiceness;
  attributes.slice_ns = kLongSlice_ns;
  if (syscall(SYS_sched_setattr, 0, &attributes, 0U) != 0)
    setpriority(PRIO_PROCESS, thread, attributes.niceness);
}

}  // namespace psi_slam
