// SPDX-License-Identifier: BSD-3-Clause
// The per-loop step: a node against every nearby finished local map.
#pragma once

#include <memory>
#include <vector>

#include "psi_slam/loop_closure/loop_candidates.h"
#include "psi_slam/loop_closure/loop_record.h"
#include "psi_slam/loop_closure/loop_verification.h"
#include "psi_slam/loop_closure/place_memory.h"
#include "psi_slam/loop_closure/scan_context.h"
#include "psi_slam/matching/matcher.h"
#include "psi_slam/pose_graph/pose_graph.h"

namespace psi_slam {

struct LoopClosureOptions {
  LoopCandidateOptions candidates;
  LoopVerificationOptions verification;
  ScanContextOptions context;
  double attempt_distance_m =
      0.5;  ///< the robot travels this far between two attempts with the same local map
};

class LoopCloser {
 public:
  explicit LoopCloser(const LoopClosureOptions& options) : options_(options) {}

  /// Matches `node` with every local map it may see again. Every attempt that found anything is returned,
  /// accepted or refused, in the order of the local maps' ids.
  std::vector<LoopRecord> close(std::size_t node, const PlaceMemory& memory, const PoseGraph& graph,
                                const Matcher& matcher);

  /// The local maps matched with by the last call of close().
  int tried() const { return tried_; }

 private:
  LoopClosureOptions options_;
  std::vector<double> last_attempt_m_;  ///< by local map: where along the path it was last matched with
  int tried_ = 0;
};

}  // namespace psi_slam
