// SPDX-License-Identifier: BSD-3-Clause
// Reduced levels of a raster. OpenGL shows the nearest pixel of a texture, so that thin walls of a map that
// is larger than the window would be dashed. Each level halves the raster and keeps its walls.
#pragma once

#include "map/rendering/map_image.h"

namespace psi_slam {

/// Number of times to halve a raster with pixels of `resolution_m` until its pixels are at least `pixel_m`
/// wide. Returns 0 if `pixel_m` is not positive.
int raster_level(double resolution_m, double pixel_m);

/// Returns the raster with half the width and height, rounded up. Of each block of 2 x 2 pixels keeps the
/// pixel with the most ink, which is the product of its opacity and darkness. Keeps the upper left corner.
MapRaster half_raster(const MapRaster& raster);

}  // namespace psi_slam
