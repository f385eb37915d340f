// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/scan_place.h"

#include <algorithm>
#include <iterator>

#include "base/number_text.h"

namespace psi_slam {

std::string place_text(const mrpt::math::TPoint2D& at) {
  return "(" + fixed_text(at.x, 1) + ", " + fixed_text(at.y, 1) + ") m";
}

double time_in_run_s(const std::vector<FrameRecord>& frames, const std::vector<std::size_t>& later_run_frames,
                     std::size_t frame) {
  const auto next = std::upper_bound(later_run_frames.begin(), later_run_frames.end(), frame);
  const std::size_t first = next == later_run_frames.begin() ? 0 : *std::prev(next);
  return seconds(frames[frame].time_us - frames[first].time_us);
}

}  // namespace psi_slam
