// SPDX-License-Identifier: BSD-3-Clause
// A made-up map of a robot that drives round a room twice. The second round may be displaced in the map.
#pragma once

#include <cmath>
#include <cstddef>

#include "simulated_room.h"

namespace psi_slam {

inline constexpr int kScansPerRound = 40;

/// Map of two rounds; every scan is a node. The poses of the second round are `map_T_true` too far.
inline MappingResult two_passes(const mrpt::math::TPose2D& map_T_true = {}) {
  const SimulatedRoom room;
  const BeamBearings bearings = even_bearings(-M_PI / 2, M_PI / 2, 181);
  MappingResult result;
  for (int i = 0; i < 2 * kScansPerRound; ++i) {
    const double turn = 2 * M_PI * i / kScansPerRound;
    const mrpt::math::TPose2D pose(1 + 2 * std::cos(turn), 1 + std::sin(turn),
                                   std::remainder(turn + M_PI / 2, 2 * M_PI));
    Frame frame = room.scan_from(pose, bearings);
    frame.index = static_cast<std::size_t>(i);
    frame.time_us = 200'000 * i;
    FrameRecord record;
    record.time_us = frame.time_us;
    record.odom_T_robot = frame.odom_T_robot;
    record.map_T_robot = i < kScansPerRound ? pose : map_T_true + pose;
    record.match = i == 0 ? ScanMatch::kNoMap : ScanMatch::kMatched;
    record.node = result.node_frames.size();
    result.graph.add_node(record.map_T_robot);
    result.node_frames.push_back(frame.index);
    result.frames.push_back(record);
    result.log.push_back(std::move(frame));
  }
  result.local_maps = {{0, 0, result.node_frames.size() - 1}};
  return result;
}

/// An accepted loop that measures the pose of `node` relative to `anchor` as in the map, moved by `off`.
inline LoopRecord loop_between(const MappingResult& result, std::size_t anchor, std::size_t node,
                               const mrpt::math::TPose2D& off = {}) {
  LoopRecord loop;
  loop.anchor = anchor;
  loop.node = node;
  loop.frame = result.node_frames[node];
  loop.anchor_T_node = (result.graph.pose(node) - result.graph.pose(anchor)) + off;
  loop.reference = anchor;
  loop.reference_T_node = loop.anchor_T_node;
  loop.covariance = Eigen::Matrix3d::Identity() * 1e-4;
  loop.state = LoopState::kAccepted;
  return loop;
}

}  // namespace psi_slam
