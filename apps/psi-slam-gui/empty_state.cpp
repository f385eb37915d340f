// SPDX-License-Identifier: BSD-3-Clause
#include "empty_state.h"

#include <wx/button.h>
#include <wx/sizer.h>
#include <wx/statbmp.h>
#include <wx/stattext.h>

#include "icons.h"

namespace psi_slam {

EmptyState::EmptyState(wxWindow* parent, const std::function<void()>& open) : wxPanel(parent) {
  auto* column = new wxBoxSizer(wxVERTICAL);
  const int gap = FromDIP(12);
  column->AddStretchSpacer(2);
  column->Add(new wxStaticBitmap(this, wxID_ANY, program_icon()), 0, wxALIGN_CENTRE | wxALL, gap);
  auto* title = new wxStaticText(this, wxID_ANY, "See a map being made");
  title->SetFont(title->GetFont().Scaled(1.6F).Bold());
  column->Add(title, 0, wxALIGN_CENTRE | wxALL, gap);
  auto* text = new wxStaticText(
      this, wxID_ANY,
      "Drop a log here, or open one: CARMEN (.log, .clf) MRPT (.rawlog), gzipped or not, or a ROS bag.\n"
      "Then press play. Settings can be changed on the right before.",
      wxDefaultPosition, wxDefaultSize, wxALIGN_CENTRE_HORIZONTAL);
  column->Add(text, 0, wxALIGN_CENTRE | wxALL, gap);
  auto* button = new wxButton(this, wxID_ANY, wxString::FromUTF8("Open a log…"));
  button->Bind(wxEVT_BUTTON, [open](wxCommandEvent&) { open(); });
  column->Add(button, 0, wxALIGN_CENTRE | wxALL, gap);
  column->AddStretchSpacer(3);
  SetSizer(column);
}

}  // namespace psi_slam
