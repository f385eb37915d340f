// SPDX-License-Identifier: BSD-3-Clause
// A rectangular room without doors, and laser scans of it, for the tests of maps and exports.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "psi_slam/frame.h"
#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// The room [x_min, x_max] x [y_min, y_max], in metres in the map frame.
struct SimulatedRoom {
  double x_min = -2;
  double x_max = 4;
  double y_min = -1;
  double y_max = 3;

  double range_m(const mrpt::math::TPose2D& map_T_laser, double bearing_rad) const {
    const double c = std::cos(map_T_laser.phi + bearing_rad);
    const double s = std::sin(map_T_laser.phi + bearing_rad);
    const double infinity = std::numeric_limits<double>::infinity();
    const double to_x = c > 0 ? (x_max - map_T_laser.x) / c : c < 0 ? (x_min - map_T_laser.x) / c : infinity;
    const double to_y = s > 0 ? (y_max - map_T_laser.y) / s : s < 0 ? (y_min - map_T_laser.y) / s : infinity;
    return std::min(to_x, to_y);
  }

  Frame scan_from(const mrpt::math::TPose2D& map_T_robot, const BeamBearings& bearings_rad) const {
    Frame frame;
    frame.odom_T_robot = map_T_robot;
    frame.scan.bearings_rad = bearings_rad;
    frame.scan.max_range_m = 30;
    frame.scan.robot_T_laser = {0.1, 0, 0};
    const auto map_T_laser = map_T_robot + frame.scan.robot_T_laser;
    for (const float bearing : *bearings_rad)
      frame.scan.ranges_m.push_back(static_cast<float>(range_m(map_T_laser, static_cast<double>(bearing))));
    return frame;
  }
};

/// `count` evenly spaced bearings from first to last, both included. `count` is at least 2.
inline BeamBearings even_bearings(double first_rad, double last_rad, int count) {
  std::vector<float> bearings;
  for (int i = 0; i < count; ++i)
    bearings.push_back(static_cast<float>(first_rad + (last_rad - first_rad) * i / (count - 1)));
  return std::make_shared<const std::vector<float>>(std::move(bearings));
}

/// A made-up result of the mapper: a walk around the room, every fifth scan a node, one accepted and one
/// rejected loop, and invented times.
inline MappingResult walk_around_the_room(int scans = 50) {
  if (scans < 26) throw std::invalid_argument("walk_around_the_room() needs 26 scans for its loops");
  const SimulatedRoom room;
  const BeamBearings bearings = even_bearings(-M_PI / 2, M_PI / 2, 181);
  MappingResult result;
  for (int i = 0; i < scans; ++i) {
    const double turn = 2 * M_PI * i / scans;
    const mrpt::math::TPose2D map_T_robot(1 + 2 * std::cos(turn), 1 + std::sin(turn),
                                          std::remainder(turn + M_PI / 2, 2 * M_PI));
    Frame frame = room.scan_from(map_T_robot, bearings);
    frame.index = static_cast<std::size_t>(i);
    frame.time_us = 976052905167303 + 200'000 * i;
    frame.odom_T_robot.x += 0.01 * i;
    FrameRecord record;
    record.time_us = frame.time_us;
    record.odom_T_robot = frame.odom_T_robot;
    record.front_end_T_robot = map_T_robot;
    record.map_T_robot = map_T_robot;
    record.match = i == 0 ? ScanMatch::kNoMap : ScanMatch::kMatched;
    record.response = i == 0 ? 0 : 0.8 + 0.1 * std::sin(i);
    record.window = {0.3, 0.3, 0.35};
    record.evaluations = 1000 + i;
    record.eta = 1 + 0.1 * i;
    record.mean_loops = i / 20;
    record.psi = record.eta * record.mean_loops;
    record.front_end_ms = 1.5;
    if (i % 5 == 0) {
      record.node = result.node_frames.size();
      record.searched_loops = true;
      record.loops_tried = 1;
      record.matcher = record.psi < 2   ? MatcherKind::kCsm
                       : record.psi < 6 ? MatcherKind::kCsmGa
                                        : MatcherKind::kGa;
      record.searches[static_cast<std::size_t>(
          record.matcher == MatcherKind::kCsm ? SearchKind::kBranchAndBound : SearchKind::kLocal)] = 1;
      record.loop_evaluations = 40;
      record.loop_matching_ms = 3.5;
      record.loop_closing_ms = 4;
      result.graph.add_node(map_T_robot);
      result.node_frames.push_back(static_cast<std::size_t>(i));
    }
    result.frames.push_back(record);
    result.log.push_back(std::move(frame));
  }
  result.local_maps = {{0, 0, 4}, {5, 5, result.node_frames.size() - 1}};
  for (std::size_t node = 1; node < result.node_frames.size(); ++node) {
    Constraint placed;
    placed.kind = Constraint::Kind::kLocalMap;
    placed.from = node <= 5 ? 0 : 5;
    placed.to = node;
    placed.from_T_to = result.graph.pose(node) - result.graph.pose(placed.from);
    placed.information = Eigen::Vector3d(2500, 2500, 60000).asDiagonal();
    result.graph.add_constraint(placed);
  }
  LoopRecord accepted;
  accepted.node = result.node_frames.size() - 1;
  accepted.frame = result.node_frames.back();
  accepted.anchor_T_node = result.frames[accepted.frame].map_T_robot - result.frames[0].map_T_robot;
  accepted.covariance = Eigen::Matrix3d::Identity() * 1e-4;
  accepted.search = SearchKind::kBranchAndBound;
  accepted.response = 0.83;
  accepted.ambiguity = 0.2;
  accepted.state = LoopState::kAccepted;
  LoopRecord rejected = accepted;
  rejected.node = 5;
  rejected.frame = result.node_frames[5];
  rejected.search = SearchKind::kExhaustive;
  rejected.response = 0.41;
  reject(rejected, {LoopRejection::Reason::kLowResponse, 0.41, 0.55});
  result.loops = {rejected, accepted};
  result.frames[accepted.frame].loops_accepted = 1;
  LoopMatcherRecord& csm = result.loop_matchers[MatcherKind::kCsm];
  csm.effort.add(SearchKind::kExhaustive, {9, 1, 200, 15.25});
  csm.effort.add(SearchKind::kBranchAndBound, {3, 1, 400, 30});
  csm.final_search_effort.add(SearchKind::kExhaustive, {2, 0, 200, 10.25});
  csm.accepted = csm.accepted_by_search[static_cast<std::size_t>(SearchKind::kBranchAndBound)] = 1;
  result.psi = {2, 6};
  result.stages = {{"match scan to local map", 50, 1.5, 0.2, 1.1, 2.4, 0.075},
                   {"close loops", 10, 4, 1, 2, 9, 0.04}};
  result.wall_s = 0.5;
  return result;
}

}  // namespace psi_slam
