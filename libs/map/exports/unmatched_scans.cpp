// SPDX-License-Identifier: BSD-3-Clause
#include "map/exports/unmatched_scans.h"

#include <algorithm>
#include <tuple>

#include "base/number_text.h"
#include "map/exports/run_summary.h"

namespace psi_slam {
namespace {

constexpr std::size_t kMostListed = 5;  // largest number of stretches in the warning

/// Text of a stretch: "12.0-19.5 s (8 scans, 6.1 m)", with times since the start of the run.
std::string stretch_text(const UnmatchedStretch& stretch, bool of_several_runs) {
  const auto since_start = [&](TimeUs time_us) {
    return fixed_text(seconds(time_us - stretch.run_start_us), 1);
  };
  return since_start(stretch.first_time_us) +
         (stretch.scans() > 1 ? '-' + since_start(stretch.last_time_us) : "") + " s " +
         (of_several_runs ? "of run " + std::to_string(stretch.run + 1) + ' ' : "") + '(' +
         counted(stretch.scans(), "scan") + ", " + fixed_text(stretch.predicted_length_m, 1) + " m)";
}

/// Drops all but the kMostListed stretches with the longest paths, and returns how many were dropped.
std::size_t keep_longest(std::vector<UnmatchedStretch>& stretches) {
  if (stretches.size() <= kMostListed) return 0;
  const std::size_t dropped = stretches.size() - kMostListed;
  std::sort(stretches.begin(), stretches.end(), [](const UnmatchedStretch& a, const UnmatchedStretch& b) {
    return std::tuple(b.predicted_length_m, b.scans(), a.first_frame) <
           std::tuple(a.predicted_length_m, a.scans(), b.first_frame);
  });
  stretches.resize(kMostListed);
  std::sort(stretches.begin(), stretches.end(), [](const UnmatchedStretch& a, const UnmatchedStretch& b) {
    return a.first_frame < b.first_frame;
  });
  return dropped;
}

/// The stretches that the verdict does not confirm; all without a verdict.
std::vector<UnmatchedStretch> doubtful_of(std::vector<UnmatchedStretch> stretches,
                                          const MapVerdict* verdict) {
  if (verdict == nullptr) return stretches;
  const std::vector<FrameSpan>& confirmed = verdict->confirmed_stretches;
  const auto is_confirmed = [&](const UnmatchedStretch& stretch) {
    return std::any_of(confirmed.begin(), confirmed.end(),
                       [&](const FrameSpan& span) { return span.begin == stretch.first_frame; });
  };
  stretches.erase(std::remove_if(stretches.begin(), stretches.end(), is_confirmed), stretches.end());
  return stretches;
}

constexpr double kNegligiblePath_m = 0.1;  // without a match, the position of a robot at rest is still known

}  // namespace

UnmatchedScans unmatched_scans(const std::vector<FrameRecord>& frames, const std::vector<FrameSpan>& runs) {
  UnmatchedScans unmatched;
  for (std::size_t run = 0; run < runs.size(); ++run) {
    const auto is_unmatched = [&, end = runs[run].end](std::size_t frame) {
      return frame < end && frames[frame].match == ScanMatch::kUnmatched;
    };
    for (std::size_t i = runs[run].begin + 1; i < runs[run].end; ++i) {
      if (!is_unmatched(i)) continue;
      UnmatchedStretch stretch;
      stretch.run = run;
      stretch.run_start_us = frames[runs[run].begin].time_us;
      stretch.first_frame = i;
      std::vector<mrpt::math::TPose2D> predicted{frames[i - 1].front_end_T_robot};
      for (; is_unmatched(i); ++i) predicted.push_back(frames[i].front_end_T_robot);
      stretch.last_frame = i - 1;
      stretch.first_time_us = frames[stretch.first_frame].time_us;
      stretch.last_time_us = frames[stretch.last_frame].time_us;
      stretch.predicted_length_m = path_length_m(predicted);
      unmatched.count += stretch.scans();
      unmatched.stretches.push_back(stretch);
    }
  }
  return unmatched;
}

std::optional<std::string> unmatched_scans_text(const MappingResult& result, const MapVerdict* verdict) {
  UnmatchedScans unmatched = unmatched_scans(result.frames, runs_of(result));
  double path_m = 0;
  for (const UnmatchedStretch& stretch : unmatched.stretches) path_m += stretch.predicted_length_m;
  if (path_m < kNegligiblePath_m) return std::nullopt;
  const bool has_odometry = std::all_of(result.log.begin(), result.log.end(),
                                        [](const Frame& frame) { return frame.has_odometry; });
  std::vector<UnmatchedStretch>& stretches = unmatched.stretches;
  const std::vector<UnmatchedStretch> doubtful = doubtful_of(stretches, verdict);
  std::string text = std::to_string(unmatched.count) + " of " + counted(result.frames.size(), "scan") +
                     " matched no local map and " + (unmatched.count == 1 ? "was" : "were") + " placed by " +
                     (has_odometry ? "odometry" : "the constant-velocity model");
  if (!doubtful.empty() && doubtful.size() < stretches.size()) {
    std::size_t scans = 0;
    for (const UnmatchedStretch& stretch : doubtful) scans += stretch.scans();
    text += ", " + std::to_string(scans) + " of them where no other scans confirm the motion";
  }
  if (!doubtful.empty()) stretches = doubtful;
  const std::size_t dropped = keep_longest(stretches);
  text += ": at ";
  for (const UnmatchedStretch& stretch : stretches)
    text += (&stretch == &stretches.front() ? "" : ", ") +
            stretch_text(stretch, !result.later_run_frames.empty());
  if (dropped > 0) text += " and " + std::to_string(dropped) + " more";
  return text +
         (doubtful.empty() ? "; the scans before and after fit each other" : "; the map may be wrong there");
}

}  // namespace psi_slam
