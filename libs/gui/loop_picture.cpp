// SPDX-License-Identifier: BSD-3-Clause
#include "gui/loop_picture.h"

#include <mrpt/math/TBoundingBox.h>

#include <algorithm>
#include <cstdint>

#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"
#include "pose_graph/constraint_error.h"

namespace psi_slam {
namespace {

constexpr double kCell_m = 0.05;
constexpr std::uint8_t kWhite = 255;
constexpr int kDarkest = 30;
constexpr int kDarkerByPoint = 75;

std::vector<mrpt::math::TPoint2D> placed(const ScanPoints& scan, const mrpt::math::TPose2D& map_T_robot) {
  std::vector<mrpt::math::TPoint2D> points;
  points.reserve(scan.points.size());
  for (const mrpt::math::TPoint2Df& point : scan.points) points.push_back(transform(map_T_robot, point));
  return points;
}

/// Returns the points of all scans of a local map, in the frame of the local map.
std::vector<mrpt::math::TPoint2D> points_of(const LocalMapRecord& map, const HistoryView<NodeScan>& nodes) {
  std::vector<mrpt::math::TPoint2D> points;
  const mrpt::math::TPose2D local_T_map = nodes[map.anchor].local_T_robot;
  for (std::size_t node = map.first_node; node <= map.last_node && node < nodes.size(); ++node) {
    if (!nodes[node].points) continue;
    for (const mrpt::math::TPoint2D& point :
         placed(*nodes[node].points, between(local_T_map, nodes[node].local_T_robot)))
      points.push_back(point);
  }
  return points;
}

/// Returns a white raster of the points. Each point makes its cell darker.
MapRaster raster_of(const std::vector<mrpt::math::TPoint2D>& points) {
  MapRaster raster;
  raster.resolution_m = kCell_m;
  if (points.empty()) return raster;
  auto all = mrpt::math::TBoundingBox::PlusMinusInfinity();
  for (const mrpt::math::TPoint2D& point : points) all.updateWithPoint({point.x, point.y, 0});
  raster.x_min_m = all.min.x - kCell_m;
  raster.y_max_m = all.max.y + kCell_m;
  raster.width_px = static_cast<int>((all.max.x - raster.x_min_m) / kCell_m) + 2;
  raster.height_px = static_cast<int>((raster.y_max_m - all.min.y) / kCell_m) + 2;
  raster.pixels.assign(std::size_t{4} * static_cast<std::size_t>(raster.width_px * raster.height_px), kWhite);
  for (const mrpt::math::TPoint2D& point : points) {
    const auto column = static_cast<int>((point.x - raster.x_min_m) / kCell_m);
    const auto row = static_cast<int>((raster.y_max_m - point.y) / kCell_m);
    std::uint8_t* const pixel =
        &raster.pixels[std::size_t{4} * static_cast<std::size_t>(row * raster.width_px + column)];
    for (int channel = 0; channel < 3; ++channel)
      pixel[channel] = static_cast<std::uint8_t>(std::max(kDarkest, pixel[channel] - kDarkerByPoint));
  }
  return raster;
}

}  // namespace

std::optional<LoopPicture> loop_picture(const ReplaySnapshot& snapshot, std::size_t index) {
  if (index >= snapshot.loops->size()) return std::nullopt;
  const LoopRecord& loop = (*snapshot.loops)[index];
  if (loop.local_map >= snapshot.local_maps.size() || loop.node >= snapshot.nodes.size()) return std::nullopt;
  if (!snapshot.nodes[loop.node].points) return std::nullopt;  // superseded
  const ScanPoints& scan = *snapshot.nodes[loop.node].points;
  LoopPicture picture{raster_of(points_of(snapshot.local_maps[loop.local_map], snapshot.nodes)),
                      placed(scan, loop.anchor_T_predicted),
                      {}};
  if (!found_nothing(loop)) picture.after = placed(scan, loop.anchor_T_node);
  return picture;
}

double loop_residual_m(const LoopRecord& loop, const std::vector<mrpt::math::TPose2D>& map_T_node) {
  const Eigen::Vector3d error =
      constraint_error(loop.reference_T_node, RotatedPose(map_T_node.at(loop.reference)),
                       RotatedPose(map_T_node.at(loop.node)));
  return portable::hypot(error.x(), error.y());
}

}  // namespace psi_slam
