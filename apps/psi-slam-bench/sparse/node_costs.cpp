// SPDX-License-Identifier: BSD-3-Clause
#include "sparse/node_costs.h"

#include <algorithm>
#include <cmath>

namespace psi_slam {
namespace {

/// Costs of all nodes, and of the nodes that tried loops.
struct Costs {
  std::vector<double> all;
  std::vector<double> with_loops;

  void add(double cost, bool tried_loops) {
    all.push_back(cost);
    if (tried_loops) with_loops.push_back(cost);
  }

  std::optional<double> ratio() const {
    const double median = quantile(with_loops, 0.5);
    return median > 0 ? std::optional(quantile(all, 1) / median) : std::nullopt;
  }
};

}  // namespace

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  const auto rank = static_cast<std::ptrdiff_t>(std::ceil(share * static_cast<double>(values.size())));
  const auto at = values.begin() + std::max<std::ptrdiff_t>(rank, 1) - 1;
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

NodeCosts node_costs(const std::vector<FrameRecord>& frames, const std::vector<double>& add_ms) {
  Costs times_ms;
  Costs evaluations;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!frames[i].node) continue;
    const bool tried_loops = frames[i].loops_tried > 0;
    times_ms.add(add_ms.at(i), tried_loops);
    evaluations.add(static_cast<double>(frames[i].evaluations), tried_loops);
  }
  return {quantile(times_ms.all, 0.5), quantile(times_ms.all, 0.99), quantile(times_ms.all, 1),
          times_ms.ratio(), evaluations.ratio()};
}

}  // namespace psi_slam
