// SPDX-License-Identifier: BSD-3-Clause
// Poses of all scans while the robot drives. A mapper moves the nodes of the graph when it closes loops; the
// scans between the nodes move along.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <vector>

#include "logs/frames/pose_operations.h"
#include "psi_slam/mapping_result.h"

namespace psi_slam {

class LivePoses {
 public:
  /// Takes the records that `frames` has more than at the last call.
  void take(const std::vector<FrameRecord>& frames) {
    for (std::size_t i = node_frames_.size(); i < frames.size(); ++i)
      node_frames_.push_back(frames[i].node || i == 0 ? i : node_frames_[i - 1]);
  }

  /// Pose of the robot in the map at a frame that was taken: the pose of the newest node at that frame, plus
  /// the motion since that node by the front end.
  mrpt::math::TPose2D map_T_robot(std::size_t frame, const std::vector<FrameRecord>& frames,
                                  const std::vector<mrpt::math::TPose2D>& map_T_node) const {
    const FrameRecord& of_node = frames[node_frames_[frame]];
    if (!of_node.node || *of_node.node >= map_T_node.size()) return frames[frame].map_T_robot;
    return compose(map_T_node[*of_node.node],
                   between(of_node.front_end_T_robot, frames[frame].front_end_T_robot));
  }

 private:
  std::vector<std::size_t> node_frames_;  ///< for each frame, the frame of the newest node
};

}  // namespace psi_slam
