// SPDX-License-Identifier: BSD-3-Clause
// Places edits of the drawn map in the frame of a map. Edits that state a pose of the robot stay on their
// walls if the frame of the exported map turns, or if their run is merged into a map of other runs.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "map/rendering/map_edits.h"

namespace psi_slam {

/// Returns the pose of the robot at a scan in the mapper's frame; empty if the scan is not mapped.
using PoseAtScan = std::function<std::optional<mrpt::math::TPose2D>(std::size_t scan)>;

/// Returns the pose of the robot in a frame in which the mapper's frame has the pose `target_T_mapper`. At
/// the origin of the mapper's frame, where most runs begin, this is `target_T_mapper` bit for bit.
mrpt::math::TPose2D robot_in_target(const mrpt::math::TPose2D& target_T_mapper,
                                    const mrpt::math::TPose2D& mapper_T_robot);

/// Returns the edit with a stated frame: an edit without one has points in the frame of the exported map, in
/// which the robot has the pose `export_T_start` at scan 0.
MapEdit with_frame(MapEdit edit, const mrpt::math::TPose2D& export_T_start);

/// Returns the edit, which must state its frame, with its points in a frame in which the mapper's frame has
/// the pose `target_T_mapper`. Points that are already in this frame keep their bits. Empty if the edit's
/// scan is not mapped.
std::optional<MapEdit> placed_edit(MapEdit edit, const mrpt::math::TPose2D& target_T_mapper,
                                   const PoseAtScan& mapper_T_robot);

struct PlacedMapEdits {
  std::vector<MapEdit> edits;          ///< with their points in the target frame
  std::vector<MapEdit> without_place;  ///< edits whose scans are not mapped
};

/// Returns placed_edit() of each edit, in their order.
PlacedMapEdits placed_edits(const std::vector<MapEdit>& edits, const mrpt::math::TPose2D& target_T_mapper,
                            const PoseAtScan& mapper_T_robot);

}  // namespace psi_slam
