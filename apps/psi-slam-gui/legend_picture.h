// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/img/CImage.h>
#include <wx/window.h>

#include "view/loop_legend.h"

namespace psi_slam {

/// Draws the legend as a box with a coloured stroke and a name for each entry, in the window's font and
/// scaling. Returns an empty picture if there are no entries.
mrpt::img::CImage legend_picture(const LoopLegend& legend, const wxWindow& window);

}  // namespace psi_slam
