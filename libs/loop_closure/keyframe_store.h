// SPDX-License-Identifier: BSD-3-Clause
// The places that the robot has visited, for loop closing: points and pose of each node, and the finished
// local maps.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <memory>
#include <vector>

#include "base/worker_pool.h"
#include "local_maps/front_end.h"
#include "loop_closure/local_map_cache.h"
#include "matching/scan_points.h"
#include "psi_slam/pose_graph.h"

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
  std::shared_ptr<LocalMapCache> cache;    ///< holds all local maps in this order; null: none is packed
};

/// An empty store with a cache. The cache keeps enough local maps unpacked for a robot that returns within
/// metres.
KeyframeStore make_keyframe_store();

/// Appends the node that the front end made of a frame.
void remember_node(const FrontEndStep& step, std::size_t frame, KeyframeStore& keyframes);

/// Noise of a node's pose in a local map, added to the front end's covariance.
struct LocalMapNoise {
  double sigma_m = 0;
  double sigma_rad = 0;
};

/// Adds a constraint from the anchor of each of its local maps to the step's node. All these nodes must be in
/// the graph.
void constrain_to_local_maps(const FrontEndStep& step, const LocalMapNoise& noise, PoseGraph& graph);

void remember_local_map(const PlacedLocalMap& finished, KeyframeStore& keyframes);

/// Unpacks local maps if there is a cache. Call before reading them.
void unpack_local_maps(const KeyframeStore& keyframes, const std::vector<std::size_t>& local_maps,
                       WorkerPool& pool);

/// Whether `node` is the first node of a stretch, if the path is divided into stretches of `stretch_m`. Loops
/// are searched at such nodes only. The choice does not depend on loops found before, so one match more or
/// less does not shift later searches. With `stretch_m` 0 every node is one.
bool begins_stretch(std::size_t node, const std::vector<NodeScan>& nodes, double stretch_m);

}  // namespace psi_slam
