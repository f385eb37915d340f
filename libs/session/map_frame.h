// SPDX-License-Identifier: BSD-3-Clause
// The frame of the exported map. The mapper's frame is the robot's first pose, unless known poses state it.
// The exported map can be turned square to its walls, and its origin can be moved: map.align, map.origin_x_m
// and map.origin_y_m.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <optional>
#include <vector>

#include "psi_slam/fixed_knowledge.h"
#include "psi_slam/frame.h"
#include "psi_slam/mapping_result.h"
#include "session/settings.h"

namespace psi_slam {

/// Throws UserError if both the options and the knowledge state the frame of the map.
void check_frame(const MapFrameOptions& options, const FixedKnowledge& knowledge);

/// Returns the pose of the mapper's frame in the exported map. `log` has the frames of `map_T_robot`.
mrpt::math::TPose2D export_T_map(const std::vector<Frame>& log,
                                 const std::vector<mrpt::math::TPose2D>& map_T_robot,
                                 const MapFrameOptions& options);
mrpt::math::TPose2D export_T_map(const MappingResult& result, const MapFrameOptions& options);
/// Returns the pose of the robot at the first scan in the exported map.
mrpt::math::TPose2D export_T_start(const MappingResult& result, const MapFrameOptions& options);
/// Returns the pose of the mapper's frame without a map; empty if it depends on the walls of the map.
std::optional<mrpt::math::TPose2D> fixed_export_T_map(const MapFrameOptions& options);

/// Moves all poses in the map of a finished result to the exported frame: those of the scans and those of the
/// pose graph. The destructor restores the former poses bit for bit.
class ExportedPoses {
 public:
  ExportedPoses(MappingResult& result, const mrpt::math::TPose2D& export_T_map);
  ~ExportedPoses();
  ExportedPoses(const ExportedPoses&) = delete;
  ExportedPoses& operator=(const ExportedPoses&) = delete;

 private:
  MappingResult& result_;
  std::vector<mrpt::math::TPose2D> map_T_robot_;
  std::vector<mrpt::math::TPose2D> map_T_node_;
};

}  // namespace psi_slam
