// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/loop_closure/place_memory.h"

#include <cmath>

namespace psi_slam {

void take_off_shelf(const PlaceMemory& memory, const std::vector<std::size_t>& local_maps, WorkerPool& pool) {
  if (memory.shelf) memory.shelf->use(local_maps, pool);
}

bool begins_stretch(std::size_t node, const std::vector<NodeScan>& nodes, double stretch_m) {
  if (node == 0 || stretch_m <= 0) return true;
  const auto stretch = [&](std::size_t i) { return std::floor(nodes[i].travelled_m / stretch_m); };
  return stretch(node) != stretch(node - 1);
}

}  // namespace psi_slam
