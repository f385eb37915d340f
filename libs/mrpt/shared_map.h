// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "mrpt/graph_mirror.h"
#include "loop_closure/keyframe_store.h"
#include "pose_graph/sparse_pose_adjustment.h"

namespace psi_slam {

/// What our deciders and our optimizer know together, each a part of it; MRPT's interfaces let them share
/// nothing but the graph. connect_deciders() gives all three the same one.
struct SharedMap {
  GraphMirror mirror;
  KeyframeStore memory;                          ///< by the node decider
  std::vector<double> odometry_m;              ///< by node: length of odometry's path up to there
  std::optional<SparsePoseAdjustment> solver;  ///< where the optimizer is ours: then poses are the mirror's
};

}  // namespace psi_slam
