// SPDX-License-Identifier: BSD-3-Clause
#include "layers.h"
#include "texture.h"

namespace psi_slam {

void draw_grid(SceneLayer& layer, const DrawnMap& map) {
  layer.clear();
  if (map.raster.width_px > 0 && map.raster.height_px > 0) layer.insert(textured_plane(map.raster));
}

}  // namespace psi_slam
