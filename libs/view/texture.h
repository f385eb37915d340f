// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/opengl/CTexturedPlane.h>

#include "rendering/map_image.h"

namespace psi_slam {

/// A plane at height 0 with the raster as its texture, transparent where the raster is, in true colours
/// whatever the light.
mrpt::opengl::CTexturedPlane::Ptr textured_plane(const MapRaster& raster);

}  // namespace psi_slam
