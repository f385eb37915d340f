// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <wx/aui/framemanager.h>
#include <wx/confbase.h>
#include <wx/frame.h>

#include "view/map_scene.h"

namespace psi_slam {

/// Keeps the arrangement of the window from one start of the program to the next: its position, its panes and
/// the map's layers.
class WindowLayout {
 public:
  /// Remembers the present panes as the default.
  WindowLayout(wxFrame& frame, wxAuiManager& panes);

  void save(wxConfigBase& config, const MapScene& scene) const;
  /// Restores what was saved, as far as it fits: keeps the window on an existing screen, and ignores saved
  /// panes that differ from the program's panes.
  void restore(wxConfigBase& config, MapScene& scene);
  void restore_default_panes();

 private:
  void restore_window(const wxConfigBase& config);
  void restore_panes(const wxString& saved);

  wxFrame& frame_;
  wxAuiManager& panes_;
  wxString default_panes_;
};

}  // namespace psi_slam
