// SPDX-License-Identifier: BSD-3-Clause
// Work done in a process of its own, so that its memory can be told apart from what was done before.
#pragma once

#include <functional>
#include <string>

namespace psi_slam {

struct ForkedResult {
  std::string text;            ///< that the work returned
  double peak_memory_mib = 0;  ///< the most that it ever held in memory
};

/// Runs `work` in a child process and waits for it. What it reports on the way, a line each, is given to
/// `observer` in this process. An exception of the work is thrown here again: a UserError as such, everything
/// else, and a child that dies, as SystemFailure. To be called when this process has no other threads.
ForkedResult run_forked(
    const std::function<std::string(const std::function<void(const std::string&)>&)>& work,
    const std::function<void(const std::string&)>& observer);

}  // namespace psi_slam
