// SPDX-License-Identifier: BSD-3-Clause
// Cost of the nodes of a run: what a scan that becomes a node costs in processor time and in scored poses.
#pragma once

#include <optional>
#include <vector>

#include "psi_slam/mapping_result.h"

namespace psi_slam {

struct NodeCosts {
  double p50_ms = 0;
  double p99_ms = 0;
  double max_ms = 0;
  /// Most expensive node over the median of the nodes that tried loops; none if no node did.
  std::optional<double> time_ratio;
  std::optional<double> evaluations_ratio;
};

/// The value at rank ceil(share n), counted from 1: the least value that this share of the values does not
/// exceed. 0 without values.
double quantile(std::vector<double> values, double share);

/// Costs of the frames that became nodes. `add_ms` are the processor times of Mapper::add, one for each
/// frame.
NodeCosts node_costs(const std::vector<FrameRecord>& frames, const std::vector<double>& add_ms);

}  // namespace psi_slam
