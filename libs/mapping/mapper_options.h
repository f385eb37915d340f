// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/degrees.h"
#include "mapping/back_end.h"
#include "mapping/local_maps/front_end.h"
#include "pose_graph/sparse_pose_adjustment.h"

namespace psi_slam {

struct MapperOptions {
  FrontEndOptions front_end;
  BackEndOptions back_end;
  PoseAdjustmentOptions pose_graph;

  bool close_loops = true;
  PathNoise path_noise;

  /// Loops found for a node correct the poses while mapping this many nodes later. The finished map does not
  /// depend on it.
  std::size_t latency_nodes = 5;
  /// Whether loops are closed in a thread of their own, beside the front end, and the younger local map is
  /// drawn in another. Has no effect on the results.
  bool back_end_thread = false;
  /// Whether Mapper::newest_covariance() is estimated. Has no effect on other results.
  bool estimates_covariance = false;
};

}  // namespace psi_slam
