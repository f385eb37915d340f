// SPDX-License-Identifier: BSD-3-Clause
#include "gui/wide_lines.h"

#include <GL/gl.h>

namespace psi_slam {

void WideLines::render(const RenderContext& context) const {
  glLineWidth(getLineWidth());
  CSetOfLines::render(context);
  glLineWidth(1);
}

}  // namespace psi_slam
