// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <wx/gdicmn.h>
#include <wx/image.h>

namespace psi_slam {

/// What is on the screen now, in pixels. (wxScreenDC shows for ever what was there when it was first asked.)
wxImage screen_image(const wxPoint& corner, const wxSize& size);

}  // namespace psi_slam
