// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <wx/panel.h>

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "replay/replay_snapshot.h"

namespace psi_slam {

/// Summary of successive scans that share a column of pixels in a plot.
struct PlotColumn {
  std::size_t first_frame = 0;
  double psi = 0;           ///< largest value
  double response_min = 0;  ///< of matched scans; 0 without any
  double response_max = 0;
  double loops_accepted = 0;  ///< number since the first scan
  double loops_tried = 0;     ///< number since the first scan
  double front_end_ms = 0;    ///< times are means over the scans
  double loops_ms = 0;
  double graph_ms = 0;
  bool unmatched = false;              ///< one of the scans matched no local map
  std::optional<MatcherKind> matcher;  ///< of the last node up to this column
};

/// Summarises all scans in `columns` columns, or in one column for each scan if there are fewer scans.
std::vector<PlotColumn> plot_columns(const HistoryView<FrameRecord>& frames, std::size_t columns);

/// The least number of 1, 2 or 5 times a power of ten that is not below `value`; the upper end of an axis.
double round_up(double value);

/// Curves of a run while it is mapped: factor Psi with its thresholds and the matchers in use, response
/// with unmatched scans, number of loops, and time per scan by stage. A click selects the scan at that place.
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
