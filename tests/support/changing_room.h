// SPDX-License-Identifier: BSD-3-Clause
// A robot that drives round after round through a room of 10 m by 7 m in which things come, go and move.
// Noise of 1 cm in the ranges.
#pragma once

#include <mrpt/math/TPoint2D.h>
#include <mrpt/math/TPose2D.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

#include "psi_slam/frame.h"
#include "simulated_room.h"

namespace psi_slam {

struct RoomWall {
  mrpt::math::TPoint2D a;
  mrpt::math::TPoint2D b;
};
using RoomWalls = std::vector<RoomWall>;

inline RoomWalls operator+(RoomWalls walls, const RoomWalls& more) {
  walls.insert(walls.end(), more.begin(), more.end());
  return walls;
}

/// The four sides of a box with this corner.
inline RoomWalls box_at(double x, double y, double width, double depth) {
  const mrpt::math::TPoint2D a(x, y);
  const mrpt::math::TPoint2D b(x + width, y);
  const mrpt::math::TPoint2D c(x + width, y + depth);
  const mrpt::math::TPoint2D d(x, y + depth);
  return {{a, b}, {b, c}, {c, d}, {d, a}};
}

/// The walls that never change: a room, and a second one behind a doorway from x = 6 to x = 7 at y = 7.
inline RoomWalls bare_room() {
  return RoomWalls{{{0, 0}, {10, 0}}, {{10, 0}, {10, 7}}, {{0, 7}, {6, 7}},   {{7, 7}, {10, 7}},
                   {{0, 7}, {0, 0}},  {{4, 7}, {4, 10}},  {{4, 10}, {9, 10}}, {{9, 10}, {9, 7}}} +
         box_at(9, 5.6, 0.6, 0.9) + box_at(0.3, 0.3, 0.9, 0.5);
}

inline const RoomWalls kDoor{{{6, 7}, {7, 7}}};
inline const RoomWalls kWall{{{3.5, 3}, {5.5, 3}}};
inline const RoomWalls kMovedWall{{{3.5, 3.8}, {5.5, 3.8}}};
inline const RoomWalls kShelf = box_at(6.2, 3.2, 0.9, 0.5);
inline const RoomWalls kPallet = box_at(2.6, 4.6, 0.7, 0.6);

class ChangingRoom {
 public:
  explicit ChangingRoom(std::size_t beams = 240, const RoomWalls& walls = bare_room())
      : bearings_(even_bearings(-M_PI, M_PI - 2 * M_PI / double(beams), int(beams))), walls_(walls) {}

  /// Drives once around the room, with a scan every 0.2 m.
  void drive_round(const RoomWalls& things) {
    const std::vector<mrpt::math::TPoint2D> corners{{1.7, 1.5}, {8.3, 1.5}, {8.3, 5.9}, {1.7, 5.9}};
    for (std::size_t k = 0; k < corners.size(); ++k) {
      const mrpt::math::TPoint2D& from = corners[k];
      const mrpt::math::TPoint2D way = corners[(k + 1) % corners.size()] - from;
      const double length_m = std::hypot(way.x, way.y);
      const double heading = std::atan2(way.y, way.x);
      for (double s = 0; s < length_m; s += 0.2)
        record({from.x + way.x * s / length_m, from.y + way.y * s / length_m, heading}, things);
    }
  }

  void record(const mrpt::math::TPose2D& pose, const RoomWalls& things) {
    const RoomWalls walls = walls_ + things;
    Frame frame;
    frame.index = log.size();
    frame.time_us = 1'000'000'000 + 300'000 * static_cast<TimeUs>(log.size());
    frame.odom_T_robot = pose;
    frame.scan.bearings_rad = bearings_;
    frame.scan.max_range_m = 30;
    for (const float bearing : *bearings_)
      frame.scan.ranges_m.push_back(static_cast<float>(
          range_m(walls, pose, pose.phi + static_cast<double>(bearing)) + noise_(random_)));
    log.push_back(frame);
    poses.push_back(pose);
  }

  std::vector<Frame> log;
  std::vector<mrpt::math::TPose2D> poses;

 private:
  static double range_m(const RoomWalls& walls, const mrpt::math::TPose2D& pose, double direction) {
    const double dx = std::cos(direction);
    const double dy = std::sin(direction);
    double nearest_m = std::numeric_limits<double>::infinity();
    for (const RoomWall& wall : walls) {
      const double ax = wall.a.x - pose.x;
      const double ay = wall.a.y - pose.y;
      const double ex = wall.b.x - wall.a.x;
      const double ey = wall.b.y - wall.a.y;
      const double d = dx * ey - dy * ex;
      if (std::abs(d) < 1e-12) continue;
      const double t = (ax * ey - ay * ex) / d;
      const double u = (ax * dy - ay * dx) / d;
      if (t > 1e-3 && u >= 0 && u <= 1) nearest_m = std::min(nearest_m, t);
    }
    return nearest_m;
  }

  BeamBearings bearings_;
  RoomWalls walls_;
  std::mt19937 random_{1};
  std::normal_distribution<double> noise_{0, 0.01};
};

}  // namespace psi_slam
