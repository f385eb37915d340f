// SPDX-License-Identifier: BSD-3-Clause
#include <mrpt/opengl/CSetOfTriangles.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "view/dots.h"
#include "view/layers.h"
#include "view/lines.h"
#include "local_maps/scan_filter.h"
#include "view/frame_pose.h"
#include "view/palette.h"

namespace psi_slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPoint3Df;
using mrpt::math::TPose2D;

constexpr double kNose_m = 0.45;  // of the arrow that stands for the robot
constexpr double kTail_m = -0.25;
constexpr double kHalfWidth_m = 0.25;

/// A rectangle of these half-widths around a pose, along its axes, with the pose's heading and how far it may
/// turn.
void add_window(mrpt::opengl::CSetOfLines& lines, const TPose2D& map_T_middle, const SearchExtent& extent) {
  const std::array<TPoint2D, 4> corners{TPoint2D(extent.x_m, extent.y_m), TPoint2D(-extent.x_m, extent.y_m),
                                        TPoint2D(-extent.x_m, -extent.y_m),
                                        TPoint2D(extent.x_m, -extent.y_m)};
  const auto line = [&](const TPoint2D& a, const TPoint2D& b) { join(lines, a, b, height_m::kWindows); };
  for (std::size_t i = 0; i < corners.size(); ++i)
    line(map_T_middle.composePoint(corners[i]), map_T_middle.composePoint(corners[(i + 1) % corners.size()]));
  const double reach_m = std::max(extent.x_m, extent.y_m);
  for (const double turn_rad : {-extent.theta_rad, extent.theta_rad})
    line({map_T_middle.x, map_T_middle.y},
         map_T_middle.composePoint({reach_m * std::cos(turn_rad), reach_m * std::sin(turn_rad)}));
}

void add_loop_window(mrpt::opengl::CSetOfLines& lines, const ReplaySnapshot& snapshot,
                     const LoopRecord& loop) {
  add_window(lines, snapshot.map_T_node->at(loop.anchor) + loop.anchor_T_predicted, loop.window);
}

}  // namespace

void draw_robot(SceneLayer& layer, const TPose2D& map_T_robot) {
  layer.clear();
  auto triangles = mrpt::opengl::CSetOfTriangles::Create();
  triangles->enableLight(false);
  mrpt::opengl::TTriangle arrow(raised(map_T_robot.composePoint({kNose_m, 0}), height_m::kRobot),
                                raised(map_T_robot.composePoint({kTail_m, kHalfWidth_m}), height_m::kRobot),
                                raised(map_T_robot.composePoint({kTail_m, -kHalfWidth_m}), height_m::kRobot));
  arrow.setColor(mrpt::img::TColor(palette::kRobot));
  triangles->insertTriangle(arrow);
  layer.insert(triangles);
}

void draw_scan(SceneLayer& layer, const Frame& frame, const TPose2D& map_T_robot) {
  layer.clear();
  ScanFilterOptions all;
  all.spacing_m = 0;
  all.max_range_m = static_cast<double>(frame.scan.max_range_m);
  for (const CompanionScan& companion : frame.companions)
    all.max_range_m = std::max(all.max_range_m, static_cast<double>(companion.scan.max_range_m));
  std::vector<TPoint3Df> points;
  for (const mrpt::math::TPoint2Df& point : matching_points(frame, all).points) {
    const TPoint2D at =
        map_T_robot.composePoint({static_cast<double>(point.x), static_cast<double>(point.y)});
    points.push_back(raised(at, height_m::kScan));
  }
  layer.insert(dots_of(points, palette::kScan, 3));
}

void draw_windows(SceneLayer& layer, const ReplaySnapshot& snapshot, std::size_t frame) {
  layer.clear();
  auto lines = lines_of(palette::kWindow, 1.5F);
  if (frame > 0) {  // the front end searches where odometry predicts the robot
    const FrameRecord& record = snapshot.frames[frame];
    const TPose2D motion = record.odom_T_robot - snapshot.frames[frame - 1].odom_T_robot;
    add_window(*lines, map_T_frame(snapshot, frame - 1) + motion, record.window);
  }
  for (const LoopRecord& loop : *snapshot.loops)
    if (loop.frame == frame && !loop.in_final_search) add_loop_window(*lines, snapshot, loop);
  layer.insert(lines);
}

void draw_loop_window(SceneLayer& layer, const ReplaySnapshot& snapshot, std::size_t loop) {
  auto lines = lines_of(palette::kWindow, 1.5F);
  add_loop_window(*lines, snapshot, (*snapshot.loops)[loop]);
  layer.insert(lines);
}

void draw_measure(SceneLayer& layer, const Measure& measure) {
  layer.clear();
  auto lines = lines_of(palette::kMeasure, 2);
  join(*lines, measure.from, measure.to, height_m::kMeasure);
  layer.insert(lines);
  layer.insert(dots_of({raised(measure.from, height_m::kMeasure), raised(measure.to, height_m::kMeasure)},
                       palette::kMeasure, 8));
}

}  // namespace psi_slam
