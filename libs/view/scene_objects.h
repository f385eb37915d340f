// SPDX-License-Identifier: BSD-3-Clause
// Dots, lines and textures for the layers of a scene.
#pragma once

#include <mrpt/img/TColor.h>
#include <mrpt/math/TPoint3D.h>
#include <mrpt/opengl/CPointCloud.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CTexturedPlane.h>

#include <vector>

#include "rendering/map_image.h"

namespace psi_slam {

/// Dots of one colour and size. (Passes all points at once because insertPoint() of MRPT 2.5 deadlocks.)
mrpt::opengl::CPointCloud::Ptr dots_of(const std::vector<mrpt::math::TPoint3Df>& points,
                                       const mrpt::img::TColor& colour, float size_px);

/// A point or pose in the plane, lifted to a height.
template <class Planar>
mrpt::math::TPoint3Df raised(const Planar& at, double z_m) {
  return {static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(z_m)};
}

/// An empty set of lines of one colour and width.
mrpt::opengl::CSetOfLines::Ptr lines_of(const mrpt::img::TColor& colour, float width);

/// Adds the line between two points or poses in the plane, at a height.
template <class Planar>
void join(mrpt::opengl::CSetOfLines& lines, const Planar& a, const Planar& b, double z_m) {
  lines.appendLine(a.x, a.y, z_m, b.x, b.y, z_m);
}

/// A plane at height 0 that shows the raster in true colours, whatever the light; transparent where the
/// raster is.
mrpt::opengl::CTexturedPlane::Ptr textured_plane(const MapRaster& raster);

}  // namespace psi_slam
