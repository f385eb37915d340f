// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/view/loop_picture.h"

#include <utility>

namespace psi_slam {
namespace {

MapRaster score_raster(const ScoreGrid& scores) {
  const ScoreLevel& finest = scores.finest();
  MapRaster raster;
  raster.width_px = finest.width();
  raster.height_px = finest.height();
  raster.resolution_m = scores.resolution_m();
  raster.x_min_m = scores.origin_x_m();
  raster.y_max_m = scores.origin_y_m() + finest.height() * scores.resolution_m();
  raster.pixels.reserve(std::size_t{4} * static_cast<std::size_t>(finest.width() * finest.height()));
  for (int y = finest.height() - 1; y >= 0; --y)
    for (int x = 0; x < finest.width(); ++x) {
      const auto shade = static_cast<std::uint8_t>(255 - finest.at(x, y) * 7 / 8);
      for (int channel = 0; channel < 3; ++channel) raster.pixels.push_back(shade);
      raster.pixels.push_back(255);
    }
  return raster;
}

std::vector<mrpt::math::TPoint2D> placed(const ScanPoints& scan, const mrpt::math::TPose2D& map_T_robot) {
  std::vector<mrpt::math::TPoint2D> points;
  points.reserve(scan.points.size());
  for (const mrpt::math::TPoint2Df& point : scan.points)
    points.push_back(map_T_robot.composePoint({static_cast<double>(point.x), static_cast<double>(point.y)}));
  return points;
}

}  // namespace

std::optional<LoopPicture> loop_picture(const ReplaySnapshot& snapshot, std::size_t index) {
  if (index >= snapshot.loops->size()) return std::nullopt;
  const LoopRecord& loop = (*snapshot.loops)[index];
  if (loop.local_map >= snapshot.local_maps.size() || loop.node >= snapshot.nodes.size()) return std::nullopt;
  const ScanPoints& scan = *snapshot.nodes[loop.node].points;
  return LoopPicture{score_raster(std::as_const(*snapshot.local_maps[loop.local_map].map).scores()),
                     placed(scan, loop.anchor_T_predicted), placed(scan, loop.anchor_T_node)};
}

}  // namespace psi_slam
