// SPDX-License-Identifier: BSD-3-Clause
// Functions that draw a snapshot into the layers of a scene. Each draw function adds its objects to an empty
// layer.
#pragma once

#include <mrpt/opengl/CSetOfObjects.h>

#include <cstddef>
#include <string>

#include "gui/map_painter.h"
#include "gui/map_scene.h"
#include "gui/replay_snapshot.h"

namespace psi_slam {

using SceneLayer = mrpt::opengl::CSetOfObjects;

/// Heights of the layers above the ground, in metres. Within a viewport the highest layer is drawn last. The
/// heights are small because perspective shifts higher layers.
namespace height_m {
inline constexpr double kLocalMaps = 0.005;
inline constexpr double kKeepOutZones = 0.005;
inline constexpr double kOdometry = 0.01;
inline constexpr double kConstraints = 0.015;
inline constexpr double kLoops = 0.02;
inline constexpr double kUncertainty = 0.0225;
inline constexpr double kTrajectory = 0.025;
inline constexpr double kUnmatched = 0.0275;
inline constexpr double kNodes = 0.03;
inline constexpr double kScan = 0.035;
inline constexpr double kWindows = 0.04;
inline constexpr double kHotSpots = 0.0425;
inline constexpr double kRobot = 0.045;
inline constexpr double kChosenLoop = 0.05;
inline constexpr double kMeasure = 0.055;
inline constexpr double kDraft = 0.06;
}  // namespace height_m

/// Draws the grid map as a textured plane. Halves its raster `level` times, see raster_levels.h.
void draw_grid(SceneLayer& layer, const DrawnMap& map, int level);

/// Draws the zones of the grid map, in the colour of their kind. Halves their rasters `level` times.
void draw_zones(SceneLayer& layer, const DrawnMap& map, int level);

/// Draws the active local maps, each in its own tint, at the origin. Halves their rasters `level` times.
void draw_local_maps(SceneLayer& layer, const ReplaySnapshot& snapshot, int level);
/// Moves the active local maps that draw_local_maps() drew to their current poses.
void place_local_maps(SceneLayer& layer, const ReplaySnapshot& snapshot);

/// Draws the path by odometry alone, starting at the first pose in the map.
void draw_odometry(SceneLayer& layer, const ReplaySnapshot& snapshot);
/// Draws the corrected path, with dots at unmatched scans.
void draw_trajectory(SceneLayer& layer, const ReplaySnapshot& snapshot);

void draw_nodes(SceneLayer& layer, const ReplaySnapshot& snapshot);
/// Draws which finished local maps hold a scan: lines from each node to the anchors of these maps.
void draw_constraints(SceneLayer& layer, const ReplaySnapshot& snapshot);
/// Draws the ellipses that contain the true positions of nodes with a probability of 95 %, true to scale, at
/// nodes at least 1 m apart. Draws nothing unless the run is finished.
void draw_uncertainty(SceneLayer& layer, const ReplaySnapshot& snapshot);
/// Draws the hot spots of the verdict: a ring around each doubtful place, and a line to a dot at its suspect.
/// The worst hot spot has the thickest ring. Draws nothing unless the run is finished.
void draw_hot_spots(SceneLayer& layer, const ReplaySnapshot& snapshot);
/// Returns the hot spot whose ring contains a place of the map; the nearest of several. Null if there is
/// none.
const HotSpot* hot_spot_at(const ReplaySnapshot& snapshot, const mrpt::math::TPoint2D& place);
/// Returns what the verdict says about a hot spot and what would help, as two sentences.
std::string hot_spot_hint(const HotSpot& spot);

/// Draws the loops that drawn_loops() chooses: at most 500 of each kind, as in the report.
void draw_loops(SceneLayer& layer, const ReplaySnapshot& snapshot, const LoopStyle& style);
/// Draws the selected loop and the window in which it was searched.
void draw_chosen_loop(SceneLayer& layer, const ReplaySnapshot& snapshot, std::size_t loop);

void draw_robot(SceneLayer& layer, const mrpt::math::TPose2D& map_T_robot);
void draw_scan(SceneLayer& layer, const Frame& frame, const mrpt::math::TPose2D& map_T_robot);
/// Draws the search windows of a scan: the window of the front end and the windows of its loops.
void draw_windows(SceneLayer& layer, const ReplaySnapshot& snapshot, std::size_t frame);

void draw_measure(SceneLayer& layer, const Measure& measure);

/// Draws the points of a draft with lines between them, and a paler line back to the first point of a
/// polygon.
void draw_draft(SceneLayer& layer, const MapDraft& draft);

}  // namespace psi_slam
