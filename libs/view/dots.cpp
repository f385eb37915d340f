// SPDX-License-Identifier: BSD-3-Clause
#include "view/dots.h"

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

}  // namespace psi_slam
