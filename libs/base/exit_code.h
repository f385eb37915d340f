// SPDX-License-Identifier: BSD-3-Clause
// Exit codes of all programs.
#pragma once

namespace psi_slam {

inline constexpr int kExitDone = 0;
inline constexpr int kExitFailed = 1;  ///< system failure, a robot that was not localized, or maps that differ
inline constexpr int kExitWrongUsageOrInput = 2;  ///< UserError, or a truncated or damaged log

}  // namespace psi_slam
