// SPDX-License-Identifier: BSD-3-Clause
// Runs a function in a child process, so that its memory can be measured separately.
#pragma once

#include <functional>
#include <string>

namespace psi_slam {

using TextObserver = std::function<void(const std::string&)>;

/// Runs `work` in a child process, waits for its end and returns its text. Passes each text that `work`
/// reports to `observer` in this process. Throws UserError if `work` does, and SystemFailure for other
/// exceptions or if the child dies. The texts must have no zero bytes, and this process no other threads.
std::string run_forked(const std::function<std::string(const TextObserver& report)>& work,
                       const TextObserver& observer);

}  // namespace psi_slam
