// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/graphslam_deciders.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

void connect_deciders(NodeDecider& node_decider, EdgeDecider& edge_decider, GraphOptimizer& optimizer) {
  auto* const front_end = dynamic_cast<CPsiFrontEndNRD*>(&node_decider);
  auto* const loop_closer = dynamic_cast<CPsiLoopCloserERD*>(&edge_decider);
  auto* const solver = dynamic_cast<CPsiSpaGSO*>(&optimizer);
  if (loop_closer != nullptr && front_end == nullptr)
    throw UserError(
        "the edge decider CPsiLoopCloserERD needs the local maps of CPsiFrontEndNRD. Choose it as the node "
        "decider, or choose another edge decider.");
  if (front_end == nullptr) return;
  if (loop_closer != nullptr) loop_closer->share(front_end->shared_map());
  if (solver != nullptr) solver->share(front_end->shared_map());
}

void finish_deciders(NodeDecider& node_decider, EdgeDecider& edge_decider, GraphOptimizer& optimizer,
                     const std::function<bool(double)>& progress) {
  if (auto* const front_end = dynamic_cast<CPsiFrontEndNRD*>(&node_decider)) front_end->finish();
  auto* const loop_closer = dynamic_cast<CPsiLoopCloserERD*>(&edge_decider);
  auto* const solver = dynamic_cast<CPsiSpaGSO*>(&optimizer);
  if (loop_closer != nullptr)
    loop_closer->finish(progress);
  else if (solver != nullptr)
    solver->finish();
}

}  // namespace psi_slam
