// SPDX-License-Identifier: BSD-3-Clause
#include "map/verdict/uncertain_stretches.h"

#include <algorithm>
#include <cmath>

namespace psi_slam {
namespace {

/// Frames of the nodes that accepted loops join, in ascending order.
std::vector<std::size_t> ends_of_loops(const MappingResult& result) {
  std::vector<std::size_t> frames;
  for (const LoopRecord& loop : result.loops) {
    if (loop.state != LoopState::kAccepted) continue;
    frames.push_back(loop.frame);
    frames.push_back(result.node_frames[loop.reference]);
  }
  std::sort(frames.begin(), frames.end());
  return frames;
}

}  // namespace

std::vector<UncertainStretch> uncertain_stretches(const MappingResult& result,
                                                  const std::vector<MapView>& views,
                                                  const std::vector<std::optional<double>>& sigmas_m,
                                                  double least_sigma_m) {
  std::vector<UncertainStretch> stretches;
  std::optional<std::size_t> last;  // view of the last stretch
  std::size_t first = 0;
  for (std::size_t view = 0; view < views.size(); ++view) {
    const double sigma_m = sigmas_m[view].value_or(0);
    if (sigma_m < least_sigma_m) continue;
    if (!last || *last + 1 != view || views[*last].run != views[view].run) {
      stretches.push_back({view, sigma_m, 0, 0, 0});
      first = view;
    }
    last = view;
    UncertainStretch& stretch = stretches.back();
    stretch.length_m = views[view].travelled_m - views[first].travelled_m;
    if (sigma_m > stretch.sigma_m) {
      stretch.worst = view;
      stretch.sigma_m = sigma_m;
    }
  }
  const std::vector<std::size_t> ends = ends_of_loops(result);
  const std::vector<FrameSpan> runs = runs_of(result);
  for (UncertainStretch& stretch : stretches) {
    const std::size_t frame = views[stretch.worst].frame;
    const FrameSpan& run = runs[views[stretch.worst].run];
    const auto before = std::lower_bound(ends.begin(), ends.end(), frame);
    const auto after = std::upper_bound(ends.begin(), ends.end(), frame);
    stretch.first_frame = before == ends.begin() ? run.begin : std::max(run.begin, *std::prev(before));
    stretch.last_frame = after == ends.end() ? run.end - 1 : std::min(run.end - 1, *after);
  }
  return stretches;
}

}  // namespace psi_slam
