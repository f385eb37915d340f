// SPDX-License-Identifier: BSD-3-Clause
// All options in a property grid made from their descriptions: unit, range and help of each, and its default.
// A value that the option does not take is refused with the sentence that the command line has for it.
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

class SettingsPanel : public wxPanel {
 public:
  struct Actions {
    std::function<void(const std::string& sentence)> refuse;  ///< a value was not taken
    std::function<void()> changed;
    std::function<void()> restart;  ///< maps the log anew with the settings as they are
  };

  /// `settings` outlive the panel.
  SettingsPanel(wxWindow* parent, BoundSettings& settings, Actions actions);

  /// Shows the settings' values as they are now.
  void refresh();
  /// Whether the run on show has other settings than these.
  void show_pending(bool pending);

  /// Types a text into an option, "section.key"; true when it was taken.
  bool enter(const std::string& name, const std::string& text);
  /// What the grid shows of an option.
  std::string shown(const std::string& name) const;
  void reset_all();

 private:
  void add_options();
  void changing(wxPropertyGridEvent& event);
  void show_context_menu(wxPropertyGridEvent& event);
  void reset(const std::string& name);
  void mark(wxPGProperty& property, const Option& option);
  bool take(const std::string& name, const std::string& text);

  BoundSettings& settings_;
  Actions actions_;
  wxPropertyGrid* grid_;
  wxStaticText* help_;
  wxStaticText* pending_;
  wxButton* restart_;
};

}  // namespace psi_slam
