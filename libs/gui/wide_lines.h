// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/opengl/CSetOfLines.h>

namespace psi_slam {

/// Lines that are drawn in their own width, in pixels of the screen. MRPT stores the width of its lines, but
/// draws all of them one pixel wide.
class WideLines : public mrpt::opengl::CSetOfLines {
 public:
  void render(const RenderContext& context) const override;
};

}  // namespace psi_slam
