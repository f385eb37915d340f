// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "view/layers.h"
#include "view/palette.h"
#include "view/texture.h"

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;

constexpr double kMostOpaque = 200;  // of a wall, out of 255
constexpr double kFreeOpaque = 70;   // of free space

/// Walls in the tint and free space in a touch of it, each the more opaque the surer it is.
MapRaster tinted_raster(const COccupancyGridMap2D& grid, const mrpt::img::TColor& tint) {
  MapRaster raster;
  raster.width_px = static_cast<int>(grid.getSizeX());
  raster.height_px = static_cast<int>(grid.getSizeY());
  raster.resolution_m = static_cast<double>(grid.getResolution());
  raster.x_min_m = static_cast<double>(grid.getXMin());
  raster.y_max_m = static_cast<double>(grid.getYMin()) + raster.height_px * raster.resolution_m;
  raster.pixels.reserve(std::size_t{4} * grid.getSizeX() * grid.getSizeY());
  for (int y = raster.height_px - 1; y >= 0; --y) {
    const COccupancyGridMap2D::cellType* row = grid.getRow(y);
    for (int x = 0; x < raster.width_px; ++x) {
      const double free = 2 * static_cast<double>(COccupancyGridMap2D::l2p(row[x])) - 1;  // -1 wall .. 1 free
      const double opaque = free < 0 ? -free * kMostOpaque : free * kFreeOpaque;
      for (const std::uint8_t channel : {tint.B, tint.G, tint.R}) raster.pixels.push_back(channel);
      raster.pixels.push_back(static_cast<std::uint8_t>(std::lround(opaque)));
    }
  }
  return raster;
}

}  // namespace

void draw_local_maps(SceneLayer& layer, const ReplaySnapshot& snapshot) {
  layer.clear();
  for (std::size_t i = 0; i < snapshot.active_local_maps.size(); ++i)
    layer.insert(textured_plane(tinted_raster(*snapshot.active_local_maps[i].occupancy,
                                              i == 0 ? palette::kOlderMap : palette::kNewerMap)));
}

void place_local_maps(SceneLayer& layer, const ReplaySnapshot& snapshot) {
  auto plane = layer.begin();
  for (const ActiveLocalMap& active : snapshot.active_local_maps) {
    const mrpt::math::TPose2D pose = snapshot.map_T_node->at(active.anchor);
    (*plane)->setPose(mrpt::math::TPose3D(pose.x, pose.y, height_m::kLocalMaps, pose.phi, 0, 0));
    ++plane;
  }
}

}  // namespace psi_slam
