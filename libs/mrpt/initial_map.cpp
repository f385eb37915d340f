// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt/initial_map.h"

#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/poses/CPose2D.h>

#include <algorithm>
#include <utility>

#include "logs/frames/max_range_study.h"
#include "logs/frames/pose_operations.h"
#include "logs/observations/observation_frames.h"
#include "mapping/local_maps/local_map.h"
#include "mapping/loop_closure/keyframe_store.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr double kFollowSpacing_m = 1;  // path length between searches
// Half-widths of the window around the predicted pose, and around a stated start.
constexpr SearchExtent kFollowWindow{0.4, 0.4, radians_from_degrees(6.0L)};
constexpr SearchExtent kStartWindow{1, 1, radians_from_degrees(15.0L)};

mrpt::maps::COccupancyGridMap2D drawn(const mrpt::maps::CSimpleMap& map, const LogOptions& log,
                                      const GridMapOptions& options) {
  const std::string place = "CMetricMapBuilderPsi::initialize: initial_map";
  RawlogLasers lasers(log);
  std::vector<Frame> frames;
  std::vector<TPose2D> poses;
  for (const auto& keyframe : map) {
    for (const mrpt::obs::CObservation::Ptr& observation : *keyframe.sf) {
      const auto seen = std::dynamic_pointer_cast<mrpt::obs::CObservation2DRangeScan>(observation);
      auto scan = seen ? lasers.scan(*seen, place) : std::nullopt;
      if (!scan) continue;
      Frame frame;
      frame.index = frames.size();
      frame.time_us = static_cast<TimeUs>(frames.size()) * 1'000'000;
      frame.scan = *std::move(scan);
      frames.push_back(std::move(frame));
      poses.push_back(mrpt::poses::CPose2D(keyframe.pose->getMeanVal()).asTPose());
    }
  }
  if (!log.max_range_m) {
    MaxRangeStudy study;
    for (const Frame& frame : frames) study.add(frame.scan);
    const MaxRanges max_ranges = study.max_ranges();
    for (Frame& frame : frames) apply_max_range(max_ranges, frame.scan);
  }
  mrpt::maps::COccupancyGridMap2D grid = *draw_grid_map(frames, poses, options);
  const auto& cells = grid.getRawMap();
  if (std::none_of(cells.begin(), cells.end(), [](auto cell) { return cell < 0; }))
    throw UserError(place + " has " + std::to_string(map.size()) +
                    " frames, but no return of a 2D range scan, expected a map with walls. Give the map of "
                    "an earlier run, or an empty one");
  return grid;
}

PriorMapOptions prior_options(const LoopConsensusOptions& consensus) {
  PriorMapOptions options;
  options.consensus = consensus;
  options.source = "initial_map";
  return options;
}

}  // namespace

InitialMap::InitialMap(const mrpt::maps::CSimpleMap& map, const LogOptions& log,
                       const GridMapOptions& options, const LoopConsensusOptions& consensus)
    : frames_(map),
      grid_(drawn(map, log, options)),
      map_(grid_, prior_options(consensus)),
      consensus_(consensus) {}

std::optional<MeasuredPose> InitialMap::follow(const Mapper& mapper) {
  const KeyframeStore& keyframes = mapper.keyframes();
  const std::size_t node = keyframes.nodes.size() - 1;
  const double travelled_m = keyframes.nodes[node].travelled_m;
  if (searched_m_ && travelled_m - *searched_m_ < kFollowSpacing_m) return std::nullopt;
  searched_m_ = travelled_m;
  const TPose2D& run_T_node = mapper.node_poses()[node];
  if (initial_T_run_) {
    const auto place = map_.place_near(node, keyframes, compose(initial_T_run_->pose, run_T_node),
                                       start_ ? kFollowWindow : kStartWindow);
    if (!place) return std::nullopt;
    start_ = PriorStart{node, place->pose};
    initial_T_run_ = *place;
  } else {
    const FoundPlace place = map_.place_anywhere(node, keyframes);
    if (!place.believed()) return std::nullopt;
    if (!consensus_.add(node, keyframes, place)) return std::nullopt;
    start_ = PriorStart{node, place.map_T_robot};
    initial_T_run_ = map_.with_errors_of_walls(place.map_T_robot);
  }
  initial_T_run_->pose = compose(start_->prior_T_node, inverse(run_T_node));
  return initial_T_run_;
}

PriorPlaces InitialMap::places(const Mapper& mapper) const {
  return map_.places(mapper, start_);
}

}  // namespace psi_slam
