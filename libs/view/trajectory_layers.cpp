// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "view/layers.h"
#include "view/lines.h"
#include "view/palette.h"

namespace psi_slam {
namespace {

using mrpt::math::TPoint3D;
using mrpt::opengl::CSetOfLines;

constexpr double kShortestLine_m = 0.05;

/// A line through points that come one by one; those next to each other are left out.
class Polyline {
 public:
  explicit Polyline(const mrpt::img::TColor& colour, float width) : lines_(lines_of(colour, width)) {}
  void add(const mrpt::math::TPose2D& pose, double z_m) {
    const TPoint3D point(pose.x, pose.y, z_m);
    if (begun_ && (point - last_).norm() < kShortestLine_m) return;
    if (begun_) lines_->appendLine(last_, point);
    last_ = point;
    begun_ = true;
  }
  /// What comes next begins a line of its own.
  void interrupt() { begun_ = false; }
  CSetOfLines::Ptr lines() const { return lines_; }

 private:
  CSetOfLines::Ptr lines_;
  TPoint3D last_{0, 0, 0};
  bool begun_ = false;
};

bool begins_drive(const ReplaySnapshot& snapshot, std::size_t frame) {
  return std::binary_search(snapshot.later_run_frames.begin(), snapshot.later_run_frames.end(), frame);
}

}  // namespace

void draw_odometry(SceneLayer& layer, const ReplaySnapshot& snapshot) {
  layer.clear();
  if (snapshot.frames.empty()) return;
  Polyline line(palette::kOdometry, 1.5F);
  const FrameRecord& first = snapshot.frames[0];
  for (std::size_t i = 0; i < snapshot.frames.size(); ++i) {
    if (begins_drive(snapshot, i)) line.interrupt();
    line.add(first.map_T_robot + (snapshot.frames[i].odom_T_robot - first.odom_T_robot), height_m::kOdometry);
  }
  layer.insert(line.lines());
}

void draw_trajectory(SceneLayer& layer, const ReplaySnapshot& snapshot) {
  layer.clear();
  Polyline line(palette::kCorrected, 2.0F);
  for (std::size_t node = 0; node < snapshot.map_T_node->size(); ++node) {
    if (begins_drive(snapshot, snapshot.nodes[node].frame)) line.interrupt();
    line.add((*snapshot.map_T_node)[node], height_m::kTrajectory);
  }
  if (!snapshot.frames.empty()) line.add(snapshot.map_T_robot, height_m::kTrajectory);
  layer.insert(line.lines());
}

}  // namespace psi_slam
