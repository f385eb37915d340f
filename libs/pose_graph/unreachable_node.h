// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include "psi_slam/user_error.h"

namespace psi_slam {

/// What to throw about a node that no chain of enabled constraints links to the root.
inline UserError unreachable_node(std::size_t node, std::size_t root) {
  return UserError("node " + std::to_string(node) + " of the pose graph is not linked to node " +
                   std::to_string(root) + ": a chain of constraints must lead there to every node");
}

}  // namespace psi_slam
