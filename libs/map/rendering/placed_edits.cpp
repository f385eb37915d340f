// SPDX-License-Identifier: BSD-3-Clause
#include "map/rendering/placed_edits.h"

#include <utility>

#include "logs/frames/pose_operations.h"

namespace psi_slam {

using mrpt::math::TPose2D;

TPose2D robot_in_target(const TPose2D& target_T_mapper, const TPose2D& mapper_T_robot) {
  return mapper_T_robot == TPose2D(0, 0, 0) ? target_T_mapper : compose(target_T_mapper, mapper_T_robot);
}

MapEdit with_frame(MapEdit edit, const TPose2D& export_T_start) {
  if (edit.frame_T_robot) return edit;
  edit.frame_T_robot = export_T_start;
  edit.scan = 0;
  return edit;
}

std::optional<MapEdit> placed_edit(MapEdit edit, const TPose2D& target_T_mapper,
                                   const PoseAtScan& mapper_T_robot) {
  const std::optional<TPose2D> at_scan = mapper_T_robot(edit.scan);
  if (!at_scan) return std::nullopt;
  const TPose2D target_T_robot = robot_in_target(target_T_mapper, *at_scan);
  if (edit.frame_T_robot == target_T_robot) return edit;
  const TPose2D target_T_frame = compose(target_T_robot, inverse(edit.frame_T_robot.value()));
  for (mrpt::math::TPoint2D& point : edit.points) point = transform(target_T_frame, point);
  edit.frame_T_robot = target_T_robot;
  return edit;
}

PlacedMapEdits placed_edits(const std::vector<MapEdit>& edits, const TPose2D& target_T_mapper,
                            const PoseAtScan& mapper_T_robot) {
  PlacedMapEdits placed;
  for (const MapEdit& edit : edits) {
    if (auto at_place = placed_edit(edit, target_T_mapper, mapper_T_robot))
      placed.edits.push_back(*std::move(at_place));
    else
      placed.without_place.push_back(edit);
  }
  return placed;
}

}  // namespace psi_slam
