// SPDX-License-Identifier: BSD-3-Clause
// Exit codes of all programs.
#pragma once

namespace psi_slam {

inline constexpr int kExitDone = 0;
inline constexpr int kExitFailed = 1;             ///< system failure, or a search without a result
inline constexpr int kExitWrongUsageOrInput = 2;  ///< UserError, or a log that ends early

}  // namespace psi_slam
