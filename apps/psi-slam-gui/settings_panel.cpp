// SPDX-License-Identifier: BSD-3-Clause
#include "settings_panel.h"

#include <wx/button.h>
#include <wx/menu.h>
#include <wx/propgrid/propgrid.h>
#include <wx/sizer.h>
#include <wx/stattext.h>

#include <utility>

#include "main_menu.h"
#include "psi_slam/user_error.h"
#include "wx_text.h"

namespace psi_slam {
namespace {

constexpr const char* kWhere = "Settings";  // source of the value, named in error messages
constexpr const char* kNoOptionSelected =
    "Select an option to read its help. Right-click an option to reset it.";
constexpr int kHelpHeight = 104;  // height of six lines, in pixels

std::string help_of(const Option& option) {
  return option.name() + ": " + option.help + "\n" + option.values() + "; default " +
         (option.default_text.empty() ? "empty" : option.default_text) + '.';
}

/// Makes the property of an option, without a value. The property shows values as a settings file does.
wxPGProperty* property_for(const Option& option) {
  const wxString label = text_of(option.unit.empty() ? option.key : option.key + "  [" + option.unit + ']');
  const wxString name = text_of(option.name());
  if (option.type == OptionType::kFlag) {
    auto* flag = new wxBoolProperty(label, name);
    flag->SetAttribute(wxPG_BOOL_USE_CHECKBOX, true);
    return flag;
  }
  if (option.type == OptionType::kChoice) {
    wxPGChoices choices;
    for (const std::string& choice : option.choices) choices.Add(text_of(choice));
    return new wxEnumProperty(label, name, choices);
  }
  return new wxStringProperty(label, name);
}

}  // namespace

SettingsPanel::SettingsPanel(wxWindow* parent, BoundSettings& settings, Actions actions)
    : wxPanel(parent), settings_(settings), actions_(std::move(actions)) {
  grid_ = new wxPropertyGrid(this, wxID_ANY, wxDefaultPosition, wxDefaultSize, wxPG_SPLITTER_AUTO_CENTER);
  grid_->SetName("settings");
  grid_->SetColumnProportion(0, 2);  // keys are longer than values
  grid_->SetColumnProportion(1, 1);
  grid_->ResetColumnSizes(true);
  help_ = new wxStaticText(this, wxID_ANY, kNoOptionSelected, wxDefaultPosition,
                           FromDIP(wxSize(-1, kHelpHeight)), wxST_NO_AUTORESIZE);
  pending_ = new wxStaticText(this, wxID_ANY, "This map was made with other settings.");
  restart_ = new wxButton(this, wxID_ANY, "Restart");
  restart_->SetToolTip("Map the log again with these settings (Ctrl+R)");
  restart_->Bind(wxEVT_BUTTON, [this](wxCommandEvent&) { choose_command(*this, kRestart); });
  const int gap = FromDIP(4);
  auto* row = new wxBoxSizer(wxHORIZONTAL);
  row->Add(pending_, 1, wxALIGN_CENTRE_VERTICAL | wxALL, gap);
  row->Add(restart_, 0, wxALL, gap);
  auto* column = new wxBoxSizer(wxVERTICAL);
  column->Add(grid_, 1, wxEXPAND);
  column->Add(help_, 0, wxEXPAND | wxALL, 2 * gap);
  column->Add(row, 0, wxEXPAND);
  SetSizer(column);
  add_options();
  grid_->Bind(wxEVT_PG_SELECTED, [this](wxPropertyGridEvent& event) {
    const wxPGProperty* const property = event.GetProperty();
    help_->SetLabel(property == nullptr ? wxString(kNoOptionSelected) : property->GetHelpString());
    help_->Wrap(GetClientSize().GetWidth() - FromDIP(16));
  });
  grid_->Bind(wxEVT_PG_CHANGING, [this](wxPropertyGridEvent& event) { changing(event); });
  grid_->Bind(wxEVT_PG_RIGHT_CLICK, [this](wxPropertyGridEvent& event) { show_context_menu(event); });
  show_pending(false);
}

void SettingsPanel::add_options() {
  for (const OptionSection& section : settings_.table.sections()) {
    auto* heading = new wxPropertyCategory(text_of("[" + section.name + "]"), text_of(section.name));
    heading->SetHelpString(text_of(section.title));
    grid_->Append(heading);
    for (const Option& option : section.options) {
      wxPGProperty* property = grid_->Append(property_for(option));
      property->SetHelpString(text_of(help_of(option)));
    }
  }
  refresh();
}

void SettingsPanel::refresh() {
  grid_->ClearSelection(false);
  for (const OptionSection& section : settings_.table.sections())
    for (const Option& option : section.options) {
      wxPGProperty* property = grid_->GetPropertyByName(text_of(option.name()));
      property->SetValueFromString(text_of(option.text()), wxPG_FULL_VALUE);
      mark(*property, option);
    }
  grid_->Refresh();
}

/// Colours the property if the option differs from its default.
void SettingsPanel::mark(wxPGProperty& property, const Option& option) {
  const bool changed = option.text() != option.default_text;
  grid_->SetPropertyTextColour(&property, changed ? wxColour(31, 97, 171) : grid_->GetCellTextColour(),
                               wxPG_DONT_RECURSE);
}

void SettingsPanel::show_pending(bool pending) {
  if (pending == restart_->IsShown()) return;
  pending_->Show(pending);
  restart_->Show(pending);
  Layout();
  if (wxPGProperty* const selected = grid_->GetSelection()) grid_->EnsureVisible(selected);
}

/// Sets an option and returns true, or reports a wrong value and returns false.
bool SettingsPanel::set(const std::string& name, const std::string& text) {
  try {
    settings_.table.set(name, text, kWhere);
    actions_.changed();
    return true;
  } catch (const UserError& error) {
    actions_.refuse(error.what());
    return false;
  }
}

void SettingsPanel::changing(wxPropertyGridEvent& event) {
  const std::string name = event.GetPropertyName().utf8_string();
  const Option& option = settings_.table.option(name, kWhere);
  wxPGProperty& property = *event.GetProperty();
  wxVariant value = event.GetValue();
  if (set(name, property.ValueToString(value, wxPG_FULL_VALUE).utf8_string())) return mark(property, option);
  event.SetValidationFailureBehavior(0);  // the message bar shows the reason: no dialog, no beep
  event.Veto();
}

bool SettingsPanel::enter(const std::string& name, const std::string& text) {
  wxPGProperty* const property = grid_->GetPropertyByName(text_of(name));
  wxVariant value = property->GetValue();
  property->StringToValue(value, text_of(text), wxPG_FULL_VALUE);
  grid_->SelectProperty(property, true);
  return grid_->ChangePropertyValue(property, value);
}

std::string SettingsPanel::shown(const std::string& name) const {
  return grid_->GetPropertyValueAsString(text_of(name)).utf8_string();
}

void SettingsPanel::reset_all() {
  for (const OptionSection& section : settings_.table.sections())
    for (const Option& option : section.options) option.assign(option.default_text);
  refresh();
  actions_.changed();
}

void SettingsPanel::show_context_menu(wxPropertyGridEvent& event) {
  const wxPGProperty* const property = event.GetProperty();
  if (property == nullptr || property->IsCategory()) return;
  const std::string name = property->GetName().utf8_string();
  const Option& option = settings_.table.option(name, kWhere);
  wxMenu menu;
  const int one =
      menu.Append(wxID_ANY, text_of("Reset to default: " +
                                    (option.default_text.empty() ? "empty" : option.default_text)))
          ->GetId();
  const int all = menu.Append(wxID_ANY, "Reset all settings")->GetId();
  const int chosen = GetPopupMenuSelectionFromUser(menu);
  if (chosen == one) set(name, option.default_text);
  if (chosen == one) refresh();
  if (chosen == all) reset_all();
}

}  // namespace psi_slam
