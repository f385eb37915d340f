// SPDX-License-Identifier: BSD-3-Clause
// A simulated run that visits a room twice, for tests of loop closing.
#pragma once

#include <cmath>
#include <vector>

#include "../mapping/local_maps/simulated_drive.h"
#include "mapping/local_maps/front_end.h"
#include "mapping/loop_closure/keyframe_store.h"
#include "psi_slam/loop_record.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

/// Two rounds of a furnished room with good odometry. The second round sees the local maps of the first.
struct TwoRounds {
  KeyframeStore keyframes;
  std::vector<mrpt::math::TPose2D> truth;  ///< true poses of the nodes
  std::size_t node = 0;                    ///< a node of the second round
  std::size_t local_map = 0;               ///< a local map of the first round near that node

  TwoRounds() {
    const SimulatedDrive drive = drive_along(
        furnished_room(),
        path_along({{2.3, 2}, {5.5, 2}, {5.5, 4}, {2.3, 4}, {2.3, 2}, {5.5, 2}, {5.5, 4}, {2.3, 4}}), {}, 5);
    FrontEndOptions options;
    options.nodes_per_local_map = 40;
    FrontEnd front_end(options);
    for (std::size_t i = 0; i < drive.frames.size(); ++i) {
      const FrontEndStep step = front_end.add(drive.frames[i]);
      if (!step.node) continue;
      NodeScan scan;
      scan.frame = i;
      scan.local_T_robot = step.local_T_robot;
      scan.points = step.points;
      if (!keyframes.nodes.empty()) {
        const mrpt::math::TPose2D motion = step.local_T_robot - keyframes.nodes.back().local_T_robot;
        scan.travelled_m = keyframes.nodes.back().travelled_m + std::hypot(motion.x, motion.y);
      }
      scan.segment = keyframes.nodes.size();
      if (!keyframes.nodes.empty()) {
        const std::size_t before = keyframes.nodes.back().segment;
        if (scan.travelled_m - keyframes.nodes[before].travelled_m < kSegment_m) scan.segment = before;
      }
      keyframes.nodes.push_back(scan);
      truth.push_back(drive.map_T_robot[i]);
      for (const PlacedLocalMap& finished : step.finished) keyframes.local_maps.push_back(finished);
    }
    while (keyframes.nodes[node].travelled_m < 12) ++node;
  }

  /// A match in a window of `half_width_m`, at the true pose moved by `off` in the robot's frame.
  LoopRecord loop(double half_width_m, const mrpt::math::TPose2D& off = {0, 0, 0}) const {
    LoopRecord result;
    result.node = node;
    result.frame = keyframes.nodes[node].frame;
    result.local_map = local_map;
    result.anchor = keyframes.local_maps[local_map].anchor;
    result.anchor_T_node = (truth[node] - truth[result.anchor]) + off;
    set_reference(result, keyframes);
    result.covariance.diagonal() << 1e-4, 1e-4, 1e-5;
    result.window = {half_width_m, half_width_m, 0.1};
    result.response = 0.8;
    result.ambiguity = 0.3;
    return result;
  }

  /// Graph of all nodes at their true poses. An exact constraint leads from each node to the next.
  PoseGraph graph() const {
    PoseGraph result;
    for (const mrpt::math::TPose2D& pose : truth) result.add_node(pose);
    for (std::size_t to = 1; to < truth.size(); ++to) {
      Constraint constraint;
      constraint.from = to - 1;
      constraint.to = to;
      constraint.from_T_to = truth[to] - truth[to - 1];
      constraint.information = Eigen::Vector3d(1e5, 1e5, 1e6).asDiagonal();
      result.add_constraint(constraint);
    }
    return result;
  }
};

inline const TwoRounds& two_rounds() {
  static const TwoRounds rounds;
  return rounds;
}

}  // namespace psi_slam
