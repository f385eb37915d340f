// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "psi_slam/loop_closure/loop_candidates.h"
#include "psi_slam/loop_closure/loop_record.h"
#include "psi_slam/loop_closure/loop_verification.h"
#include "psi_slam/matching/matcher.h"

namespace psi_slam {

/// Matches `scan`, the points of a node or its context, with one local map and verifies what was found; none
/// when no pose of the window scores near enough.
std::optional<LoopRecord> attempt_loop(std::size_t node, const ScanPoints& scan,
                                       const LoopCandidate& candidate, const PlaceMemory& memory,
                                       const Matcher& matcher, const LoopVerificationOptions& verification);

}  // namespace psi_slam
