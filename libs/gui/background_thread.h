// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <future>
#include <utility>

namespace psi_slam {

/// Calls `work` in a thread of lower priority, so that the window's thread runs first. Threads that `work`
/// starts inherit the priority. The destructor of the returned future waits for the thread.
template <class Work>
auto run_in_background(Work work) {
  return std::async(std::launch::async, [work = std::move(work)] {
    constexpr int kNiceness = 5;
    setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNiceness);  // on Linux, affects one thread only
    return work();
  });
}

/// True once the thread of a std::future or std::shared_future has ended.
template <class Future>
bool has_ended(const Future& future) {
  return future.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace psi_slam
