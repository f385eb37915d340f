// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "mapping/loop_closure/loop_candidates.h"
#include "mapping/loop_closure/loop_verification.h"
#include "mapping/loop_closure/matcher_policy.h"
#include "psi_slam/loop_record.h"

namespace psi_slam {

struct LoopAttempt {
  std::optional<LoopRecord> loop;  ///< empty if the scan has no points to match
  LoopEffort effort;
};

/// Matches `scan` with one local map and verifies the match. `scan` holds the points of the node or of its
/// context. `least_response` is the smallest response of a match. The local map must be unpacked. `run_seed`
/// becomes MatchSeed::run. Thread-safe.
LoopAttempt attempt_loop(std::size_t node, const ScanPoints& scan, const LoopCandidate& candidate,
                         double least_response, const KeyframeStore& keyframes, const NodeMatchers& matchers,
                         const LoopVerificationOptions& verification, std::uint64_t run_seed);

}  // namespace psi_slam
