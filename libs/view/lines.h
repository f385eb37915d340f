// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/img/TColor.h>
#include <mrpt/opengl/CSetOfLines.h>

namespace psi_slam {

/// No lines yet, of one colour and width.
inline mrpt::opengl::CSetOfLines::Ptr lines_of(const mrpt::img::TColor& colour, float width) {
  auto lines = mrpt::opengl::CSetOfLines::Create();
  lines->setColor_u8(colour);
  lines->setLineWidth(width);
  return lines;
}

/// Adds the line between two points or poses of the plane, at a height.
template <class Planar>
void join(mrpt::opengl::CSetOfLines& lines, const Planar& a, const Planar& b, double z_m) {
  lines.appendLine(a.x, a.y, z_m, b.x, b.y, z_m);
}

}  // namespace psi_slam
