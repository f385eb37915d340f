// SPDX-License-Identifier: BSD-3-Clause
#include "map/verdict/path_suspects.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"

namespace psi_slam {
namespace {

/// Motion by odometry between two successive frames, metres; turns count with a lever of 1 m.
double motion_m(const FrameRecord& from, const FrameRecord& to) {
  const mrpt::math::TPose2D step = between(from.odom_T_robot, to.odom_T_robot);
  return portable::hypot(step.x, step.y) + std::abs(mrpt::math::wrapToPi(step.phi));
}

constexpr double kLeastGap_s = 2;
constexpr double kGapSteps = 10;  // shortest gap, as a multiple of the median time between scans

double seconds_between(const FrameRecord& from, const FrameRecord& to) {
  return 1e-6 * static_cast<double>(to.time_us - from.time_us);
}

/// Shortest time between two scans that is a gap, seconds; infinite without two scans.
double least_gap_s(const std::vector<FrameRecord>& frames) {
  std::vector<double> steps_s;
  for (std::size_t i = 1; i < frames.size(); ++i)
    steps_s.push_back(seconds_between(frames[i - 1], frames[i]));
  if (steps_s.empty()) return std::numeric_limits<double>::infinity();
  const auto middle = steps_s.begin() + static_cast<std::ptrdiff_t>(steps_s.size() / 2);
  std::nth_element(steps_s.begin(), middle, steps_s.end());
  return std::max(kLeastGap_s, kGapSteps * *middle);
}

}  // namespace

std::vector<PathSuspect> path_suspects(const MappingResult& result, double min_doubt_m) {
  const std::vector<FrameRecord>& frames = result.frames;
  std::vector<PathSuspect> suspects;
  const double gap_s = least_gap_s(frames);
  for (const FrameSpan& run : runs_of(result)) {
    for (std::size_t i = run.begin + 1; i < run.end; ++i)
      if (seconds_between(frames[i - 1], frames[i]) >= gap_s)
        suspects.push_back({PathSuspect::Kind::kGap, i, i, 0});
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
