// SPDX-License-Identifier: BSD-3-Clause
// The curves of a run, made as fine as a picture can show them: each column of pixels stands for some scans.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "replay/replay_snapshot.h"

namespace psi_slam {

/// What the scans of one column come to.
struct PlotColumn {
  std::size_t first_frame = 0;
  double psi = 0;           ///< the largest of them
  double response_min = 0;  ///< of matched scans; 0 where none was
  double response_max = 0;
  std::size_t loops_accepted = 0;  ///< up to here, from the beginning
  std::size_t loops_tried = 0;
  double front_end_ms = 0;  ///< means over the scans
  double loops_ms = 0;
  double graph_ms = 0;
  std::optional<MatcherKind> matcher;  ///< of the last node among them, or before
};

/// At most `columns` columns over all scans; as many as there are scans where they are fewer.
std::vector<PlotColumn> plot_columns(const HistoryView<FrameRecord>& frames, std::size_t columns);

/// A round number not below `value`, for the upper end of an axis: 1, 2 or 5 times a power of ten.
double round_up(double value);

}  // namespace psi_slam
