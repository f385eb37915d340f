// SPDX-License-Identifier: BSD-3-Clause
#include "view/layers.h"
#include "view/texture.h"

namespace psi_slam {
namespace {

// Transparent planes are drawn in the order of their distances: the gridmap before the local maps upon it.
constexpr float kFarBelow_m = -1000;

}  // namespace

void draw_grid(SceneLayer& layer, const DrawnMap& map) {
  layer.clear();
  if (map.raster.width_px == 0 || map.raster.height_px == 0) return;
  const auto plane = textured_plane(map.raster);
  plane->setLocalRepresentativePoint({0, 0, kFarBelow_m});
  layer.insert(plane);
}

}  // namespace psi_slam
