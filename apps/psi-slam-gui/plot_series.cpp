// SPDX-License-Identifier: BSD-3-Clause
#include "plot_series.h"

#include <algorithm>
#include <cmath>

namespace psi_slam {
namespace {

void add(PlotColumn& column, const FrameRecord& frame) {
  column.psi = std::max(column.psi, frame.psi);
  if (frame.response > 0) {
    column.response_min =
        column.response_max == 0 ? frame.response : std::min(column.response_min, frame.response);
    column.response_max = std::max(column.response_max, frame.response);
  }
  column.loops_accepted += std::max(0, frame.loops_accepted);
  column.loops_tried += std::max(0, frame.loops_tried);
  column.front_end_ms += frame.front_end_ms;
  column.loops_ms += frame.loop_closing_ms;
  column.graph_ms += frame.pose_graph_ms;
  if (frame.matcher) column.matcher = frame.matcher;
}

}  // namespace

std::vector<PlotColumn> plot_columns(const HistoryView<FrameRecord>& frames, std::size_t columns) {
  std::vector<PlotColumn> result;
  const std::size_t count = std::min(columns, frames.size());
  result.reserve(count);
  PlotColumn before;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t first = i * frames.size() / count;
    const std::size_t end = (i + 1) * frames.size() / count;
    PlotColumn column;
    column.first_frame = first;
    column.matcher = before.matcher;
    column.loops_accepted = before.loops_accepted;
    column.loops_tried = before.loops_tried;
    for (std::size_t frame = first; frame < end; ++frame) add(column, frames[frame]);
    const auto scans = static_cast<double>(end - first);
    for (double* mean : {&column.front_end_ms, &column.loops_ms, &column.graph_ms}) *mean /= scans;
    before = column;
    result.push_back(std::move(column));
  }
  return result;
}

double round_up(double value) {
  if (!(value > 0)) return 1;
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double digit : {1.0, 2.0, 5.0})
    if (value <= digit * power * (1 + 1e-9)) return digit * power;
  return 10 * power;
}

}  // namespace psi_slam
