// SPDX-License-Identifier: BSD-3-Clause
#include "loop_actions.h"

#include <wx/button.h>
#include <wx/menu.h>
#include <wx/sizer.h>

#include "main_menu.h"
#include "wx_text.h"

namespace psi_slam {
namespace {

constexpr int kMargin = 14;  // of a button beside its text

}  // namespace

LoopActions::LoopActions(wxWindow* parent) : wxPanel(parent) {
  SetSizer(new wxBoxSizer(wxHORIZONTAL));
  add(kDeleteLoop, "Delete", "The selected loop is none (Delete)");
  add(kForceLoop, "Force", "The match of the selected loop is right: nothing switches it off");
  add(kMatchLoop, "Match again", "Match the selected scan and local map again by another matcher");
  add(kRestoreLoop, "Restore", "Take back what was done to the selected loop");
  add(kAddLoop, "Add…", "Point at the same thing twice to add a loop (L)");
}

void LoopActions::add(int command, const char* label, const char* tip) {
  auto* const button =
      new wxButton(this, command, wxString::FromUTF8(label), wxDefaultPosition, wxDefaultSize, wxBU_EXACTFIT);
  button->SetMinSize(wxSize(button->GetBestSize().GetWidth() + FromDIP(kMargin), -1));
  button->SetToolTip(wxString::FromUTF8(tip));
  button->Bind(wxEVT_BUTTON, [this, command, button](wxCommandEvent&) {
    if (command == kMatchLoop) {
      wxMenu menu;
      for (int matcher = 0; matcher < kMatchers; ++matcher)
        menu.Append(kMatchLoopBy + matcher, matcher_title(matcher));
      const int chosen = GetPopupMenuSelectionFromUser(menu, button->GetPosition());
      if (chosen != wxID_NONE) QueueEvent(new wxCommandEvent(wxEVT_MENU, chosen));
      return;
    }
    QueueEvent(new wxCommandEvent(wxEVT_MENU, command));  // goes up to the window, which has the commands
  });
  GetSizer()->Add(button, 0, wxALIGN_CENTRE_VERTICAL | wxLEFT, FromDIP(3));
  buttons_.push_back(button);
}

void LoopActions::enable(int command, bool enabled) {
  for (wxButton* button : buttons_)
    if (button->GetId() == command && button->IsEnabled() != enabled) button->Enable(enabled);
}

}  // namespace psi_slam
