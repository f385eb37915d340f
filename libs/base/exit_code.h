// SPDX-License-Identifier: BSD-3-Clause
// Exit codes of all programs.
#pragma once

namespace psi_slam {

inline constexpr int kExitDone = 0;
inline constexpr int kExitFailed = 1;             ///< system failure, or a robot that was not localized
inline constexpr int kExitWrongUsageOrInput = 2;  ///< UserError, or a truncated or damaged log

// Exit codes of comparisons, as diff and cmp have them. kExitDone: no difference.
inline constexpr int kExitDifferent = 1;
inline constexpr int kExitNotCompared = 2;  ///< UserError or system failure

}  // namespace psi_slam
