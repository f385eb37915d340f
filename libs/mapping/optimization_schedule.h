// SPDX-License-Identifier: BSD-3-Clause
// Decides when to optimise a growing pose graph. If the graph strongly contradicts a new constraint, the
// optimisation is due at once. After a weak contradiction, above one standard deviation, the optimisation is
// due when the graph has grown by a fixed share. The cost per node then hardly depends on the graph's size.
#pragma once

#include <algorithm>
#include <cstddef>

#include "psi_slam/pose_graph.h"

namespace psi_slam {

class OptimizationSchedule {
 public:
  /// Residuals of at least this many standard deviations are urgent.
  static constexpr double kUrgentResidual = 5;

  /// Adds the residual of a new constraint, in standard deviations.
  void add_residual(double residual) { worst_residual_ = std::max(worst_residual_, residual); }

  bool is_due(const PoseGraph& graph) const {
    if (worst_residual_ >= kUrgentResidual) return true;
    const auto nodes = static_cast<double>(graph.num_nodes());
    return worst_residual_ > 1 &&
           nodes - static_cast<double>(optimized_nodes_) >= kGrowthForSmallResidual * nodes;
  }

  /// Records that the graph has just been optimised.
  void optimized(const PoseGraph& graph) {
    worst_residual_ = 0;
    optimized_nodes_ = graph.num_nodes();
  }

 private:
  static constexpr double kGrowthForSmallResidual = 1e-3;

  double worst_residual_ = 0;  ///< largest residual since the last optimisation
  std::size_t optimized_nodes_ = 0;
};

}  // namespace psi_slam
