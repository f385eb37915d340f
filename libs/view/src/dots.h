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

}  // namespace psi_slam
