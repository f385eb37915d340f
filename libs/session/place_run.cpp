// SPDX-License-Identifier: BSD-3-Clause
#include "session/place_run.h"

#include <algorithm>
#include <limits>

#include "logs/frames/discarded_ranges.h"
#include "logs/frames/pose_operations.h"
#include "mapping/local_maps/front_end.h"
#include "psi_slam/localizer.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

// Travel over which the robot must be tracked before its place in the map counts as found.
constexpr double kFollowed_m = 2.0;

/// The last scan that fitted the map: the robot's pose in the map and relative to the run's first scan.
struct Sighting {
  TPose2D map_T_robot;
  TPose2D start_T_robot;
};

/// Returns the runs whose place was never found. Their poses are not in the map's frame.
std::vector<FrameSpan> unplaced_runs_of(const MappingResult& mapped) {
  std::vector<FrameSpan> unplaced;
  for (const FrameSpan& run : runs_of(mapped))
    if (std::any_of(mapped.interruptions.begin(), mapped.interruptions.end(),
                    [&](const Interruption& one) { return one.frame == run.begin && !one.found_frame; }))
      unplaced.push_back(run);
  return unplaced;
}

/// Returns the start of the run relative to the node that is nearest to the robot's place in `seen`.
RunStart seen_from_nearest_node(const MappingResult& mapped, const Sighting& seen) {
  const TPose2D map_T_start = compose(seen.map_T_robot, inverse(seen.start_T_robot));
  RunStart start;
  double nearest_m = std::numeric_limits<double>::infinity();
  const std::vector<FrameSpan> unplaced = unplaced_runs_of(mapped);
  const auto is_placed = [&](std::size_t frame) {
    return std::none_of(unplaced.begin(), unplaced.end(),
                        [&](const FrameSpan& run) { return run.begin <= frame && frame < run.end; });
  };
  for (std::size_t node = 0; node < mapped.node_frames.size(); ++node) {
    if (!is_placed(mapped.node_frames[node])) continue;
    const TPose2D& there = mapped.frames[mapped.node_frames[node]].map_T_robot;
    const double apart_m = distance_m(seen.map_T_robot, there);
    if (apart_m >= nearest_m) continue;
    nearest_m = apart_m;
    start = {node, between(there, map_T_start), seen.start_T_robot};
  }
  return start;
}

/// Follows the robot until its pose is certain, for at most `end` frames. Returns nothing if the robot was
/// not found, and sets `why_not` to the reason why the last search was rejected.
std::optional<Sighting> find(FrameSource& frames, std::size_t end, Localizer& localizer, FrontEnd& way,
                             bool start_is_known, const std::atomic<bool>& stop,
                             const ShareObserver& progress, std::string& why_not) {
  std::optional<Sighting> seen;
  double followed_m = 0;
  for (std::size_t read = 0; read != end; ++read) {
    std::optional<Frame> frame;
    try {
      frame = frames.next();
    } catch (const UserError&) {
      if (read == 0) throw;  // later damage is reported when the run is mapped
    }
    if (!frame) break;
    if (stop) throw SystemFailure("interrupted before a run was placed in the map. Nothing was merged");
    if (progress) progress(frames.progress());
    const TPose2D start_T_robot = way.add(*frame).local_T_robot;
    if (!has_ranges(*frame)) continue;  // superseded, or the robot stands still
    const LocalizationStep step = localizer.add(*frame);
    if (step.search && !step.search->believed()) why_not = step.search->objection;
    if (step.state == LocalizationStep::State::kLost) {
      if (start_is_known) return std::nullopt;
      seen.reset();
      followed_m = 0;
      continue;
    }
    followed_m += step.moved_m;
    if (step.fits) seen = Sighting{step.map_T_robot, start_T_robot};
    if (step.fits && followed_m >= kFollowed_m) return seen;
  }
  return seen;  // the run ended before kFollowed_m of travel
}

}  // namespace

RunStart place_run(const MappingResult& mapped, const mrpt::maps::COccupancyGridMap2D& grid,
                   const SessionInput& run, const Settings& settings,
                   const std::optional<TPose2D>& map_T_start, const std::atomic<bool>& stop,
                   const ShareObserver& progress) {
  Localizer localizer(grid, localizer_options(settings));
  if (map_T_start) localizer.start_at(*map_T_start);
  FrontEnd way(settings.mapper.front_end);
  const auto frames = open_input(run, settings).frames;
  const auto& recording = run.recording();
  const bool has_later_runs = recording && !recording->facts.runs.empty();
  const std::size_t end =
      has_later_runs ? recording->facts.runs.front().scan : std::numeric_limits<std::size_t>::max();
  std::string why_not = "it is too short for a search";
  const auto seen = find(*frames, end, localizer, way, map_T_start.has_value(), stop, progress, why_not);
  if (seen) return seen_from_nearest_node(mapped, *seen);
  const std::string name = names_of(run.logs());
  if (map_T_start)
    throw UserError(name +
                    " does not begin near --start: its scans do not fit the map there. Correct --start, " +
                    "or leave it out to search the whole map");
  throw UserError(name + " cannot be placed in the map of the runs before it: " + why_not +
                  ". State roughly where it begins with --start X,Y,YAW_DEG");
}

}  // namespace psi_slam
