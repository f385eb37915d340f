// SPDX-License-Identifier: BSD-3-Clause
#include "speed_dialog.h"

#include <wx/choice.h>
#include <wx/sizer.h>
#include <wx/spinctrl.h>
#include <wx/stattext.h>

namespace psi_slam {
namespace {

constexpr int kPercent = 0;  // entries of the choice of the unit
constexpr double kUsual_percent = 30;
constexpr double kUsual_mps = 0.3;

}  // namespace

SpeedDialog::SpeedDialog(wxWindow* parent, const SpeedLimit& proposed)
    : wxDialog(parent, wxID_ANY, "Add slow zone"),
      value_(new wxSpinCtrlDouble(this, wxID_ANY)),
      unit_(new wxChoice(this, wxID_ANY)) {
  unit_->Append("% of the robot's largest speed");
  unit_->Append("m/s");
  unit_->Bind(wxEVT_CHOICE, [this](wxCommandEvent&) { choose_percent(unit_->GetSelection() == kPercent); });
  choose_percent(proposed.max_speed_mps <= 0);
  if (proposed.percent > 0) value_->SetValue(proposed.percent);
  if (proposed.max_speed_mps > 0) value_->SetValue(proposed.max_speed_mps);
  const int gap = FromDIP(12);
  auto* row = new wxBoxSizer(wxHORIZONTAL);
  row->Add(value_, wxSizerFlags().CentreVertical());
  row->Add(unit_, wxSizerFlags().CentreVertical().Border(wxLEFT, gap / 2));
  auto* column = new wxBoxSizer(wxVERTICAL);
  column->Add(new wxStaticText(this, wxID_ANY,
                               "Largest speed in the zone. All slow zones of a map need the same unit."),
              wxSizerFlags().Border(wxALL, gap));
  column->Add(row, wxSizerFlags().Border(wxLEFT | wxRIGHT, gap));
  column->Add(CreateButtonSizer(wxOK | wxCANCEL), wxSizerFlags().Expand().Border(wxALL, gap));
  SetSizerAndFit(column);
  CentreOnParent();
}

void SpeedDialog::choose_percent(bool percent) {
  unit_->SetSelection(percent ? kPercent : kPercent + 1);
  value_->SetDigits(percent ? 0 : 2);
  value_->SetIncrement(percent ? 5 : 0.05);
  value_->SetRange(percent ? 1 : 0.01, percent ? 99 : 100);
  value_->SetValue(percent ? kUsual_percent : kUsual_mps);
}

SpeedLimit SpeedDialog::limit() const {
  const double value = value_->GetValue();
  return unit_->GetSelection() == kPercent ? SpeedLimit{value, 0} : SpeedLimit{0, value};
}

std::optional<SpeedLimit> ask_for_speed(wxWindow& parent, const SpeedLimit& proposed) {
  SpeedDialog dialog(&parent, proposed);
  if (dialog.ShowModal() != wxID_OK) return std::nullopt;
  return dialog.limit();
}

}  // namespace psi_slam
