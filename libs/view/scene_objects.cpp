// SPDX-License-Identifier: BSD-3-Clause
#include "view/scene_objects.h"

#include <utility>

namespace psi_slam {

mrpt::opengl::CPointCloud::Ptr dots_of(const std::vector<mrpt::math::TPoint3Df>& points,
                                       const mrpt::img::TColor& colour, float size_px) {
  std::vector<float> x;
  std::vector<float> y;
  std::vector<float> z;
  for (const mrpt::math::TPoint3Df& point : points) {
    x.push_back(point.x);
    y.push_back(point.y);
    z.push_back(point.z);
  }
  auto dots = mrpt::opengl::CPointCloud::Create();
  dots->setAllPoints(x, y, z);
  dots->setColor_u8(colour);
  dots->setPointSize(size_px);
  dots->enableVariablePointSize(false);
  return dots;
}

mrpt::opengl::CSetOfLines::Ptr lines_of(const mrpt::img::TColor& colour, float width) {
  auto lines = mrpt::opengl::CSetOfLines::Create();
  lines->setColor_u8(colour);
  lines->setLineWidth(width);
  return lines;
}

mrpt::opengl::CTexturedPlane::Ptr textured_plane(const MapRaster& raster) {
  const auto width = static_cast<unsigned>(raster.width_px);
  const auto height = static_cast<unsigned>(raster.height_px);
  mrpt::img::CImage colour(width, height, mrpt::img::CH_RGB);
  mrpt::img::CImage opacity(width, height, mrpt::img::CH_GRAY);
  // MRPT's textures start with the bottom row, rasters with the top row.
  for (unsigned row = 0; row < height; ++row) {
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
