// SPDX-License-Identifier: BSD-3-Clause
// Exit codes of all programs.
#pragma once

namespace psi_slam {

inline constexpr int kExitDone = 0;
inline constexpr int kExitFailed = 1;  ///< system failure, or not localised at the end of psi-slam localize
inline constexpr int kExitWrongUsageOrInput = 2;  ///< UserError, or a log that ends early

}  // namespace psi_slam
