// SPDX-License-Identifier: BSD-3-Clause
// Dialog that asks for the largest speed in a slow zone.
#pragma once

#include <wx/dialog.h>

#include <optional>

class wxChoice;
class wxSpinCtrlDouble;

namespace psi_slam {

/// Largest speed in a zone. One of the two members is 0.
struct SpeedLimit {
  double percent = 0;        ///< share of the robot's largest speed, 1 to 99
  double max_speed_mps = 0;  ///< speed, above 0
};

class SpeedDialog : public wxDialog {
 public:
  /// Proposes a limit; 30 % if both members are 0.
  SpeedDialog(wxWindow* parent, const SpeedLimit& proposed);

  /// The limit that the dialog shows.
  SpeedLimit limit() const;
  /// Chooses the unit: percent or m/s. Sets a usual value.
  void choose_percent(bool percent);

 private:
  wxSpinCtrlDouble* value_;
  wxChoice* unit_;
};

/// Asks in a SpeedDialog. Returns nothing if the user cancels.
std::optional<SpeedLimit> ask_for_speed(wxWindow& parent, const SpeedLimit& proposed);

}  // namespace psi_slam
