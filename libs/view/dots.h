// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/img/TColor.h>
#include <mrpt/math/TPoint3D.h>
#include <mrpt/opengl/CPointCloud.h>

#include <vector>

namespace psi_slam {

/// Points of one colour and size. (MRPT 2.5's own insertPoint() locks itself out: they are all given at
/// once.)
mrpt::opengl::CPointCloud::Ptr dots_of(const std::vector<mrpt::math::TPoint3Df>& points,
                                       const mrpt::img::TColor& colour, float size_px);

/// A point or pose of the plane, at a height.
template <class Planar>
mrpt::math::TPoint3Df raised(const Planar& at, double z_m) {
  return {static_cast<float>(at.x), static_cast<float>(at.y), static_cast<float>(z_m)};
}

}  // namespace psi_slam
