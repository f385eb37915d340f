// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// As lists of them are ordered.
inline constexpr std::array<LoopVerdict, 6> kLoopVerdicts{LoopVerdict::kAccepted,    LoopVerdict::kPending,
                                                          LoopVerdict::kRefused,     LoopVerdict::kSwitchedOff,
                                                          LoopVerdict::kNotFound,    LoopVerdict::kDeleted};

/// "accepted", "pending", "refused", "switched off", "not found" or "deleted".
inline const char* verdict_text(LoopVerdict verdict) {
  switch (verdict) {
    case LoopVerdict::kAccepted:
      return "accepted";
    case LoopVerdict::kPending:
      return "pending";
    case LoopVerdict::kRefused:
      return "refused";
    case LoopVerdict::kSwitchedOff:
      return "switched off";
    case LoopVerdict::kNotFound:
      return "not found";
    case LoopVerdict::kDeleted:
      return "deleted";
  }
  return "";
}

}  // namespace psi_slam
