// SPDX-License-Identifier: BSD-3-Clause
// The arrangement of the window from one start of the program to the next: its position, its panes and the
// map's layers.
#pragma once

#include <wx/aui/framemanager.h>
#include <wx/confbase.h>
#include <wx/frame.h>

#include "view/map_scene.h"

namespace psi_slam {

void save_layout(wxConfigBase& config, const wxFrame& frame, wxAuiManager& panes, const MapScene& scene);

/// Restores what was saved, as far as it fits: keeps the window on an existing screen, and ignores saved
/// panes that differ from the present panes.
void restore_layout(wxConfigBase& config, wxFrame& frame, wxAuiManager& panes, MapScene& scene);

}  // namespace psi_slam
