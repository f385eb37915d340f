// SPDX-License-Identifier: BSD-3-Clause
// What every program ends with.
#pragma once

namespace psi_slam {

inline constexpr int kExitDone = 0;
inline constexpr int kExitFailed = 1;             ///< the system's fault, or what was looked for was not found
inline constexpr int kExitWrongUsageOrInput = 2;  ///< what the user can mend: UserError, a log that breaks off

}  // namespace psi_slam
