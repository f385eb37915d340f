// SPDX-License-Identifier: BSD-3-Clause
// Cost of the nodes of a run: processor time and number of scored poses of each scan that becomes a node.
#pragma once

#include <optional>
#include <vector>

#include "psi_slam/mapping_result.h"

namespace psi_slam {

struct NodeCosts {
  double p50_ms = 0;
  double p99_ms = 0;
  double max_ms = 0;
  /// Time and number of scored poses of the most expensive node, each divided by the median of the nodes that
  /// tried loops. Empty if the median is 0 or no node tried a loop.
  std::optional<double> time_ratio;
  std::optional<double> evaluations_ratio;
};

/// Least value that at least `share` of the values do not exceed: the value of rank ceil(share n), counted
/// from 1. Returns 0 without values.
double quantile(std::vector<double> values, double share);

/// Costs of the frames that became nodes. `add_ms` are the processor times of Mapper::add, one for each
/// frame.
NodeCosts node_costs(const std::vector<FrameRecord>& frames, const std::vector<double>& add_ms);

}  // namespace psi_slam
