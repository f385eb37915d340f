// SPDX-License-Identifier: BSD-3-Clause
// What loop closing remembers of the places the robot has been: each node's points and pose in the front
// end's frame, and the finished local maps.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "base/worker_pool.h"
#include "local_maps/front_end.h"
#include "loop_closure/local_map_cache.h"
#include "matching/scan_points.h"

namespace psi_slam {

struct NodeScan {
  std::size_t frame = 0;              ///< in the log's order
  mrpt::math::TPose2D local_T_robot;  ///< in the front end's frame
  double travelled_m = 0;             ///< along the path from the first node to this one
  std::shared_ptr<const ScanPoints> points;
};

struct KeyframeStore {
  std::vector<NodeScan> nodes;             ///< by node number
  std::vector<PlacedLocalMap> local_maps;  ///< finished ones, in the order of their ids
  std::shared_ptr<LocalMapCache> cache;  ///< that all of them lie on, in this order; none: nothing is packed
};

/// Empty, with a shelf that keeps those local maps unpacked that the robot comes by again within metres.
KeyframeStore make_keyframe_store();

/// Appends the node that the front end has made of a frame, which it is asked for.
void remember_node(const FrontEndStep& step, std::size_t frame, KeyframeStore& memory);

void remember_local_map(const PlacedLocalMap& finished, KeyframeStore& memory);

/// Before local maps are looked at: unpacks them, where there is a shelf.
void unpack_local_maps(const KeyframeStore& memory, const std::vector<std::size_t>& local_maps, WorkerPool& pool);

/// Whether `node` is the first in its stretch, when the path is cut into stretches of `stretch_m`. Loops are
/// looked for at such nodes only, whichever were found before: one match more or less does not shift all that
/// follow. Every node is one when `stretch_m` is 0.
bool begins_stretch(std::size_t node, const std::vector<NodeScan>& nodes, double stretch_m);

}  // namespace psi_slam
