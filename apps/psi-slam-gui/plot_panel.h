// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <wx/panel.h>

#include <functional>
#include <memory>
#include <optional>

#include "replay/replay_snapshot.h"

namespace psi_slam {

/// Curves of a run while it is mapped: factor Psi with its thresholds and the matchers in use, response,
/// number of loops, and time per scan by stage. A click selects the scan at that place.
class PlotPanel : public wxPanel {
 public:
  PlotPanel(wxWindow* parent, std::function<void(std::size_t)> go_to);

  void show(const std::shared_ptr<const ReplaySnapshot>& snapshot, std::optional<std::size_t> frame);
  void show_nothing();

 private:
  void paint();
  wxRect strip(int index) const;

  std::function<void(std::size_t)> go_to_;
  std::shared_ptr<const ReplaySnapshot> snapshot_;
  std::optional<std::size_t> frame_;
};

}  // namespace psi_slam
