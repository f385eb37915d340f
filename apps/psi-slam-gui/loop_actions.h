// SPDX-License-Identifier: BSD-3-Clause
// What can be done with a loop: the commands of the Edit menu as buttons.
#pragma once

#include <wx/panel.h>

#include <vector>

class wxButton;

namespace psi_slam {

class LoopActions : public wxPanel {
 public:
  explicit LoopActions(wxWindow* parent);

  /// As the menu has it.
  void enable(int command, bool enabled);

 private:
  void add(int command, const char* label, const char* tip);

  std::vector<wxButton*> buttons_;
};

}  // namespace psi_slam
