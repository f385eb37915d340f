// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <wx/panel.h>

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "gui/replay_snapshot.h"

namespace psi_slam {

/// Summary of successive scans that share a column of pixels in a plot.
struct PlotColumn {
  std::size_t first_frame = 0;
  double psi = 0;           ///< largest Ψ of the scans
  double response_min = 0;  ///< least response above 0; 0 if there is none
  double response_max = 0;
  double loops_accepted = 0;  ///< number since the first scan
  double loops_tried = 0;     ///< number since the first scan
  double front_end_ms = 0;    ///< times are means over the scans
  double loops_ms = 0;
  double graph_ms = 0;
  bool unmatched = false;              ///< at least one of the scans is unmatched
  std::optional<MatcherKind> matcher;  ///< matcher that Ψ chose at the last node up to this column
};

/// Summarises all scans in `columns` columns, or in one column per scan if there are fewer scans than
/// columns.
std::vector<PlotColumn> plot_columns(const HistoryView<FrameRecord>& frames, std::size_t columns);

/// Upper end of an axis up to `value`: the least number not below it that is 1, 2 or 5 times a power of ten.
/// Returns 1 if `value` is not positive.
double round_up(double value);

/// Plots of a run while it is mapped: factor Ψ with its thresholds and the matchers in use, response with
/// unmatched scans, number of loops, and time per scan by stage. A click selects the scan at the mouse
/// pointer.
class PlotPanel : public wxPanel {
 public:
  PlotPanel(wxWindow* parent, std::function<void(std::size_t)> go_to);

  void show(const std::shared_ptr<const ReplaySnapshot>& snapshot, std::optional<std::size_t> frame);

 private:
  void paint();
  wxRect strip(int index) const;

  std::function<void(std::size_t)> go_to_;
  std::shared_ptr<const ReplaySnapshot> snapshot_;
  std::optional<std::size_t> frame_;
};

}  // namespace psi_slam
