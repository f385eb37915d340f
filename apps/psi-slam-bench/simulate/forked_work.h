// SPDX-License-Identifier: BSD-3-Clause
// Runs a function in a child process, so that its memory can be measured separately.
#pragma once

#include <functional>
#include <string>

namespace psi_slam {

struct ForkedResult {
  std::string text;            ///< returned by the function
  double peak_memory_mib = 0;  ///< largest resident set of the child
};

/// Runs `work` in a child process and waits for its end. Passes each text that `work` reports to `observer`
/// in this process. Throws UserError if `work` does, and SystemFailure for other exceptions or if the child
/// dies. This process must have no other threads.
ForkedResult run_forked(
    const std::function<std::string(const std::function<void(const std::string&)>&)>& work,
    const std::function<void(const std::string&)>& observer);

}  // namespace psi_slam
