// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <wx/gdicmn.h>
#include <wx/image.h>

namespace psi_slam {

/// Picture of a part of the screen; corner and size are in pixels. Replaces wxScreenDC, which never updates
/// its first picture.
wxImage screen_image(const wxPoint& corner, const wxSize& size);

}  // namespace psi_slam
