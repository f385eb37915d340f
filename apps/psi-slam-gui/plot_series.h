// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
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
  std::optional<MatcherKind> matcher;  ///< of the last node up to this column
};

/// Summarises all scans in `columns` columns, or in one column for each scan if there are fewer scans.
std::vector<PlotColumn> plot_columns(const HistoryView<FrameRecord>& frames, std::size_t columns);

/// The least number of 1, 2 or 5 times a power of ten that is not below `value`; the upper end of an axis.
double round_up(double value);

}  // namespace psi_slam
