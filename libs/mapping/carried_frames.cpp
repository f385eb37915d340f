// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/carried_frames.h"

#include <algorithm>

#include "logs/frames/pose_operations.h"

namespace psi_slam {

using mrpt::math::TPose2D;

void carry_frames_along(const std::vector<TPose2D>& map_T_node, const std::vector<std::size_t>& node_frames,
                        std::vector<FrameRecord>& frames, const std::vector<std::size_t>& later_run_frames) {
  const auto begins_run = [&](std::size_t frame) {
    return std::binary_search(later_run_frames.begin(), later_run_frames.end(), frame);
  };
  std::size_t node = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    while (node + 1 < node_frames.size() && node_frames[node + 1] <= i) ++node;
    const TPose2D front_end_T_robot = frames[i].front_end_T_robot;
    const auto carried = [&](std::size_t by) {
      return compose(map_T_node[by], between(frames[node_frames[by]].front_end_T_robot, front_end_T_robot));
    };
    TPose2D pose = carried(node);
    if (node + 1 < node_frames.size() && !begins_run(node_frames[node + 1])) {
      const TPose2D next = carried(node + 1);
      const double u = static_cast<double>(i - node_frames[node]) /
                       static_cast<double>(node_frames[node + 1] - node_frames[node]);
      const TPose2D off = between(pose, next);
      pose = compose(pose, TPose2D(u * off.x, u * off.y, u * off.phi));
    }
    frames[i].map_T_robot = pose;
    frames[i].map_T_robot.normalizePhi();
  }
}

}  // namespace psi_slam
