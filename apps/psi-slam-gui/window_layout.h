// SPDX-License-Identifier: BSD-3-Clause
// How the user has arranged the window, from one run to the next.
#pragma once

#include <wx/aui/framemanager.h>
#include <wx/confbase.h>
#include <wx/frame.h>

#include "view/map_scene.h"

namespace psi_slam {

class WindowLayout {
 public:
  /// Takes down what the window looks like before the user touches it.
  WindowLayout(wxFrame& frame, wxAuiManager& panes);

  void save(wxConfigBase& config, const MapScene& scene) const;
  /// What was saved, as far as it fits: the window comes to lie on a screen that is there, and every pane of
  /// this program keeps its place when the saved ones are others.
  void restore(wxConfigBase& config, MapScene& scene);
  /// The panes as they were at first.
  void restore_default_panes();

 private:
  void restore_window(const wxConfigBase& config);
  void restore_panes(const wxString& saved);

  wxFrame& frame_;
  wxAuiManager& panes_;
  wxString default_panes_;
};

}  // namespace psi_slam
