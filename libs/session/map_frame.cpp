// SPDX-License-Identifier: BSD-3-Clause
#include "session/map_frame.h"

#include "base/number_text.h"
#include "logs/frames/pose_operations.h"
#include "map/exports/mapped_trajectory.h"
#include "map/rendering/placed_edits.h"
#include "map/rendering/wall_direction.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

/// Sets the poses of all scans and nodes.
void set_poses(MappingResult& result, const std::vector<mrpt::math::TPose2D>& map_T_robot,
               const std::vector<mrpt::math::TPose2D>& map_T_node) {
  for (std::size_t i = 0; i < map_T_robot.size(); ++i) result.frames[i].map_T_robot = map_T_robot[i];
  for (std::size_t i = 0; i < map_T_node.size(); ++i) result.graph.set_pose(i, map_T_node[i]);
}

std::vector<mrpt::math::TPose2D> moved(std::vector<mrpt::math::TPose2D> poses,
                                       const mrpt::math::TPose2D& export_T_map) {
  for (mrpt::math::TPose2D& pose : poses) pose = compose(export_T_map, pose);
  return poses;
}

mrpt::math::TPose2D exported_frame(double turn_rad, const MapFrameOptions& options) {
  return {0 - options.origin_x_m, 0 - options.origin_y_m, turn_rad};  // never -0, which has another text
}

}  // namespace

void check_frame(const MapFrameOptions& options, const FixedKnowledge& knowledge) {
  const bool is_moved =
      options.align != MapFrameOptions::kNone || options.origin_x_m != 0 || options.origin_y_m != 0;
  if (knowledge.states_frame() && is_moved)
    throw UserError(
        "the lines pose and tag of the edits state the frame of the map, but map.align, map.origin_x_m or "
        "map.origin_y_m change it. Remove these settings, or the lines");
}

mrpt::math::TPose2D export_T_map(const std::vector<Frame>& log,
                                 const std::vector<mrpt::math::TPose2D>& map_T_robot,
                                 const MapFrameOptions& options) {
  if (const auto fixed = fixed_export_T_map(options)) return *fixed;
  return exported_frame(0 - wall_direction_rad(log, map_T_robot), options);
}

mrpt::math::TPose2D export_T_map(const MappingResult& result, const MapFrameOptions& options) {
  return export_T_map(result.log, mapped_poses(result), options);
}

mrpt::math::TPose2D export_T_start(const MappingResult& result, const MapFrameOptions& options) {
  const mrpt::math::TPose2D export_T_mapper = export_T_map(result, options);
  return result.frames.empty() ? export_T_mapper
                               : robot_in_target(export_T_mapper, result.frames.front().map_T_robot);
}

std::optional<mrpt::math::TPose2D> fixed_export_T_map(const MapFrameOptions& options) {
  if (options.align == MapFrameOptions::kWalls) return std::nullopt;
  const bool turned = options.align != MapFrameOptions::kNone;
  return exported_frame(turned ? parse_degrees(options.align).value_or(0) : 0, options);
}

ExportedPoses::ExportedPoses(MappingResult& result, const mrpt::math::TPose2D& export_T_map)
    : result_(result) {
  if (export_T_map == mrpt::math::TPose2D(0, 0, 0)) return;
  map_T_robot_ = mapped_poses(result);
  map_T_node_ = result.graph.poses();
  set_poses(result, moved(map_T_robot_, export_T_map), moved(map_T_node_, export_T_map));
}

ExportedPoses::~ExportedPoses() {
  set_poses(result_, map_T_robot_, map_T_node_);
}

}  // namespace psi_slam
