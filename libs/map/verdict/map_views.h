// SPDX-License-Identifier: BSD-3-Clause
// The scans of a finished map that the verdict compares with each other: nodes at regular steps of the path.
#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <optional>
#include <vector>

#include "logs/frames/pose_operations.h"
#include "matching/surface_alignment.h"
#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// Findings at successive views belong together if they are at most this many views apart.
inline constexpr std::size_t kLargestStep = 3;

struct MapViewOptions {
  double step_m = 0.5;          ///< least distance between successive views of a run
  double turn_rad = 0.5;        ///< a turn by this angle starts a new view, too
  std::size_t max_points = 90;  ///< largest number of surface points of a view
};

/// Scan of the first laser of a node. Refers to the scan in the result, which must outlive the view.
struct MapView {
  std::size_t node = 0;
  std::size_t frame = 0;
  std::size_t run = 0;     ///< number of the run, as in runs_of()
  double travelled_m = 0;  ///< path from the start of the run
  mrpt::math::TPose2D map_T_robot;
  const LaserScan* scan = nullptr;
  SurfacePoints surfaces;  ///< in the robot's frame
  /// Unit vector in the robot's frame along which all lasers leave the position open, see open_direction().
  std::optional<mrpt::math::TPoint2D> open_direction{};

  mrpt::math::TPose2D map_T_laser() const { return compose(map_T_robot, scan->robot_T_laser); }
};

/// Returns the view of one frame of a map, with run and travelled_m 0. Empty for a frame without ranges, and
/// for a scan whose bearings neither increase nor decrease throughout.
std::optional<MapView> view_of_frame(const MappingResult& result, std::size_t frame,
                                     const MapViewOptions& options = {});

/// Returns the views of a map in the order of the log. Leaves out nodes without a
/// view_of_frame().
std::vector<MapView> map_views(const MappingResult& result, const MapViewOptions& options = {});

/// Returns whether two views belong to different passes: to different runs, or to parts of one run that are
/// more than `apart_m` of path from each other.
bool are_different_passes(const MapView& a, const MapView& b, double apart_m);

}  // namespace psi_slam
