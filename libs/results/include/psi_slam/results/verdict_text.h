// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "psi_slam/mapping/mapping_result.h"

namespace psi_slam {

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
