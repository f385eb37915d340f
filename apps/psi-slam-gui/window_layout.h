// SPDX-License-Identifier: BSD-3-Clause
// Saves the position of the window, its panes and the visible layers of the map, and restores them when the
// program starts again.
#pragma once

#include <wx/aui/framemanager.h>
#include <wx/confbase.h>
#include <wx/frame.h>

#include "gui/map_scene.h"

namespace psi_slam {

/// Gives a window the size that it has without a saved layout: 1500 x 960, or less on smaller screens.
void set_first_size(wxFrame& frame);

/// Saves the visible layers and the style of loops, and writes the file at once.
void save_layers(wxConfigBase& config, const MapScene& scene);

/// Saves the position of the window, its panes and the layers, and writes the file at once.
void save_layout(wxConfigBase& config, const wxFrame& frame, wxAuiManager& panes, const MapScene& scene);

/// Restores the saved layout as far as it fits: keeps the window on an existing screen, and ignores a layout
/// with other panes.
void restore_layout(wxConfigBase& config, wxFrame& frame, wxAuiManager& panes, MapScene& scene);

}  // namespace psi_slam
