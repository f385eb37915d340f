// SPDX-License-Identifier: BSD-3-Clause
#include "verdict/path_suspects.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>

namespace psi_slam {
namespace {

/// Motion by odometry between two successive frames, metres; turns count with a lever of 1 m.
double motion_m(const FrameRecord& from, const FrameRecord& to) {
  const mrpt::math::TPose2D step = to.odom_T_robot - from.odom_T_robot;
  return std::hypot(step.x, step.y) + std::abs(mrpt::math::wrapToPi(step.phi));
}

}  // namespace

std::vector<PathSuspect> path_suspects(const MappingResult& result, double min_doubt_m) {
  const std::vector<FrameRecord>& frames = result.frames;
  std::vector<PathSuspect> suspects;
  for (const FrameSpan& run : runs_of(result)) {
    for (std::size_t i = run.begin + 1; i < run.end; ++i) {
      if (frames[i].match != ScanMatch::kUnmatched) continue;
      PathSuspect suspect{PathSuspect::Kind::kUnmatched, i, i, 0};
      for (; i < run.end && frames[i].match == ScanMatch::kUnmatched; ++i) {
        suspect.last_frame = i;
        suspect.doubt_m += motion_m(frames[i - 1], frames[i]);
      }
      if (suspect.doubt_m >= min_doubt_m) suspects.push_back(suspect);
    }
  }
  for (const Interruption& lost : result.interruptions)
    suspects.push_back({lost.found_frame ? PathSuspect::Kind::kLost : PathSuspect::Kind::kUnplaced,
                        lost.frame, lost.found_frame.value_or(lost.frame), 0});
  std::stable_sort(suspects.begin(), suspects.end(),
                   [](const PathSuspect& a, const PathSuspect& b) { return a.first_frame < b.first_frame; });
  return suspects;
}

}  // namespace psi_slam
