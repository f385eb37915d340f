// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <wx/panel.h>

#include <functional>
#include <string>

#include "session/settings.h"

class wxButton;
class wxPGProperty;
class wxPropertyGridEvent;
class wxPropertyGrid;
class wxStaticText;

namespace psi_slam {

/// Property grid of all options. A text below the grid explains the selected option. Rejects a wrong value
/// with the same message as the command line.
class SettingsPanel : public wxPanel {
 public:
  struct Actions {
    std::function<void(const std::string& sentence)> refuse;  ///< called with the reason for a rejected value
    std::function<void()> changed;                            ///< called after a value has changed
  };

  /// `settings` must outlive the panel.
  SettingsPanel(wxWindow* parent, BoundSettings& settings, Actions actions);

  /// Shows the current values of the settings.
  void refresh();
  /// Shows or hides the note that the map was made with other settings.
  void show_pending(bool pending);

  /// Enters a value for the option "section.key", as if it were typed. Returns true if it is accepted.
  bool enter(const std::string& name, const std::string& text);
  /// The value that the grid shows for an option.
  std::string shown(const std::string& name) const;
  void reset_all();

 private:
  void add_options();
  void changing(wxPropertyGridEvent& event);
  void show_context_menu(wxPropertyGridEvent& event);
  void mark(wxPGProperty& property, const Option& option);
  bool set(const std::string& name, const std::string& text);

  BoundSettings& settings_;
  Actions actions_;
  wxPropertyGrid* grid_;
  wxStaticText* help_;
  wxStaticText* pending_;
  wxButton* restart_;
};

}  // namespace psi_slam
