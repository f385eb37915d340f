// SPDX-License-Identifier: BSD-3-Clause
// A mapped log of a simulated run, once around the office and again along its first corridor. Its nodes have
// the true poses of the robot.
#pragma once

#include <cmath>
#include <utility>

#include "../mapping/local_maps/simulated_drive.h"
#include "match/loop_cases.h"

namespace psi_slam {

inline MappedLog map_office() {
  std::vector<mrpt::math::TPose2D> path =
      path_along({{1.6, 1.6}, {18.3, 1.6}, {18.3, 12.4}, {1.6, 12.4}, {1.6, 1.6}, {14, 1.6}}, 0.15, 0.15);
  const SimulatedDrive drive = drive_along(office_floor(), path, OdometryErrors(), 1);
  MappedLog log;
  log.name = "office";
  log.options.front_end.nodes_per_local_map = 20;
  FrontEnd front_end(log.options.front_end);
  const auto keep = [&log](const std::vector<PlacedLocalMap>& finished) {
    log.memory.local_maps.insert(log.memory.local_maps.end(), finished.begin(), finished.end());
  };
  for (const Frame& frame : drive.frames) {
    const FrontEndStep step = front_end.add(frame);
    keep(step.finished);
    if (!step.node) continue;
    NodeScan node;
    node.frame = frame.index;
    node.local_T_robot = step.local_T_robot;
    node.points = step.points;
    if (!log.memory.nodes.empty()) {
      const mrpt::math::TPose2D motion = step.local_T_robot - log.memory.nodes.back().local_T_robot;
      node.travelled_m = log.memory.nodes.back().travelled_m + std::hypot(motion.x, motion.y);
    }
    log.memory.nodes.push_back(std::move(node));
    log.map_T_node.push_back(drive.map_T_robot[frame.index]);
  }
  keep(front_end.finish());
  return log;
}

/// The result of map_office(), computed once for all tests.
inline const MappedLog& office_log() {
  static const MappedLog kLog = map_office();
  return kLog;
}

/// Options that give positive and negative cases in the small office.
inline CaseOptions office_cases() {
  CaseOptions options;
  options.window_m = 1;
  options.window_rad = 0.3;
  options.clear_m = 6;
  options.count = 12;
  return options;
}

}  // namespace psi_slam
