// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "loop_closure/loop_candidates.h"
#include "psi_slam/loop_record.h"
#include "loop_closure/loop_verification.h"
#include "loop_closure/matcher_policy.h"

namespace psi_slam {

struct LoopAttempt {
  std::optional<LoopRecord> loop;  ///< none when the scan is blind: it cannot be searched for
  LoopEffort effort;               ///< of no attempt then
};

/// Matches `scan`, the points of a node or its context, with one local map and verifies what was found.
/// `run_seed` is that of MatchSeed. Safe to call from several threads at once.
LoopAttempt attempt_loop(std::size_t node, const ScanPoints& scan, const LoopCandidate& candidate,
                         const KeyframeStore& memory, const ChosenMatcher& matcher,
                         const LoopVerificationOptions& verification, std::uint64_t run_seed);

}  // namespace psi_slam
