// SPDX-License-Identifier: BSD-3-Clause
#include "base/thread_priority.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdint>

namespace psi_slam {
namespace {

// A larger difference would let other programs of the robot stop a thread for which others may wait.
constexpr int kLowNiceness = 2;

// On one processor, a thread that wakes up waits until the time slice of a running one ends: about 3 ms by
// default. Linux before 6.12 ignores this value.
constexpr std::uint64_t kTimeSlice_ns = 200'000;

/// Argument of the system call sched_setattr, first version. Debian 12 has no header for it that other
/// headers of the system allow.
struct SchedulingAttributes {
  std::uint32_t size = sizeof(SchedulingAttributes);
  std::uint32_t policy = 0;  // that of normal threads
  std::uint64_t flags = 0;
  std::int32_t niceness = 0;
  std::uint32_t real_time_priority = 0;
  std::uint64_t time_slice_ns = 0;
  std::uint64_t deadline_ns = 0;
  std::uint64_t period_ns = 0;
};
static_assert(sizeof(SchedulingAttributes) == 48);

}  // namespace

void set_priority_of_this_thread(ThreadPriority priority) {
  if (priority == ThreadPriority::kNormal) return;
  const auto thread = static_cast<id_t>(gettid());  // on Linux, niceness belongs to a single thread
  const int niceness = getpriority(PRIO_PROCESS, thread) + kLowNiceness;
  setpriority(PRIO_PROCESS, thread, niceness);
  SchedulingAttributes attributes;
  attributes.niceness = niceness;
  attributes.time_slice_ns = kTimeSlice_ns;
  syscall(SYS_sched_setattr, 0, &attributes, 0);
}

}  // namespace psi_slam
