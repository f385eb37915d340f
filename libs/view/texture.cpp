// SPDX-License-Identifier: BSD-3-Clause
#include "view/texture.h"

#include <utility>

namespace psi_slam {

mrpt::opengl::CTexturedPlane::Ptr textured_plane(const MapRaster& raster) {
  const auto width = static_cast<unsigned>(raster.width_px);
  const auto height = static_cast<unsigned>(raster.height_px);
  mrpt::img::CImage colour(width, height, mrpt::img::CH_RGB);
  mrpt::img::CImage opacity(width, height, mrpt::img::CH_GRAY);
  for (unsigned row = 0; row < height; ++row) {  // MRPT's textures begin below, rasters above
    const std::uint8_t* from = raster.pixels.data() + std::size_t{4} * width * (height - 1 - row);
    auto* to = colour.ptrLine<std::uint8_t>(row);
    auto* to_opacity = opacity.ptrLine<std::uint8_t>(row);
    for (unsigned column = 0; column < width; ++column, from += 4, to += 3) {
      to[0] = from[0];
      to[1] = from[1];
      to[2] = from[2];
      to_opacity[column] = from[3];
    }
  }
  auto plane = mrpt::opengl::CTexturedPlane::Create();
  plane->assignImage(std::move(colour), std::move(opacity));
  plane->mrpt::opengl::CRenderizableShaderTexturedTriangles::enableLight(false);
  const double x_max_m = raster.x_min_m + raster.width_px * raster.resolution_m;
  const double y_min_m = raster.y_max_m - raster.height_px * raster.resolution_m;
  plane->setPlaneCorners(static_cast<float>(raster.x_min_m), static_cast<float>(x_max_m),
                         static_cast<float>(y_min_m), static_cast<float>(raster.y_max_m));
  return plane;
}

}  // namespace psi_slam
