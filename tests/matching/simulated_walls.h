// SPDX-License-Identifier: BSD-3-Clause
// A building of straight walls. Laser ranges are computed by intersecting every beam with every wall.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace psi_slam {

struct SimulatedWalls {
  struct Wall {
    double x0;
    double y0;
    double x1;
    double y1;
  };
  struct Box {
    double x_min;
    double y_min;
    double x_max;
    double y_max;
  };

  std::vector<Wall> walls;

  void add_wall(double x0, double y0, double x1, double y1) { walls.push_back({x0, y0, x1, y1}); }
  void add_box(double x_min, double y_min, double x_max, double y_max) {
    add_wall(x_min, y_min, x_max, y_min);
    add_wall(x_max, y_min, x_max, y_max);
    add_wall(x_max, y_max, x_min, y_max);
    add_wall(x_min, y_max, x_min, y_min);
  }

  Box bounding_box() const {
    const double inf = std::numeric_limits<double>::infinity();
    Box box = {inf, inf, -inf, -inf};
    for (const Wall& wall : walls) {
      box.x_min = std::min({box.x_min, wall.x0, wall.x1});
      box.y_min = std::min({box.y_min, wall.y0, wall.y1});
      box.x_max = std::max({box.x_max, wall.x0, wall.x1});
      box.y_max = std::max({box.y_max, wall.y0, wall.y1});
    }
    return box;
  }

  /// Returns the distance of a point to the nearest wall, in metres. Infinite without walls.
  double distance_m(double x, double y) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Wall& wall : walls) {
      const double along_x = wall.x1 - wall.x0;
      const double along_y = wall.y1 - wall.y0;
      const double u = std::clamp(
          ((x - wall.x0) * along_x + (y - wall.y0) * along_y) / (along_x * along_x + along_y * along_y), 0.0,
          1.0);
      nearest = std::min(nearest, std::hypot(x - wall.x0 - u * along_x, y - wall.y0 - u * along_y));
    }
    return nearest;
  }

  /// Returns the distance in metres along a beam to the first wall. Infinite if the beam hits no wall.
  double range_m(const mrpt::math::TPose2D& map_T_laser, double bearing_rad) const {
    const double c = std::cos(map_T_laser.phi + bearing_rad);
    const double s = std::sin(map_T_laser.phi + bearing_rad);
    double nearest = std::numeric_limits<double>::infinity();
    for (const Wall& wall : walls) {
      const double along_x = wall.x1 - wall.x0;
      const double along_y = wall.y1 - wall.y0;
      const double determinant = along_x * s - along_y * c;
      if (std::abs(determinant) < 1e-12) continue;
      const double to_x = wall.x0 - map_T_laser.x;
      const double to_y = wall.y0 - map_T_laser.y;
      const double range = (along_x * to_y - along_y * to_x) / determinant;
      const double u = (c * to_y - s * to_x) / determinant;
      if (range > 0 && u >= 0 && u <= 1) nearest = std::min(nearest, range);
    }
    return nearest;
  }
};

/// Returns a room of 8 m x 6 m with furniture, in which all places look different.
inline SimulatedWalls furnished_room() {
  SimulatedWalls room;
  room.add_box(0, 0, 8, 6);
  room.add_box(1.0, 1.0, 1.7, 1.4);
  room.add_box(6.1, 4.2, 6.9, 5.3);
  room.add_wall(2.5, 6.0, 3.1, 5.2);
  room.add_wall(8.0, 1.5, 7.2, 2.2);
  room.add_wall(4.0, 0.0, 4.0, 0.9);
  return room;
}

}  // namespace psi_slam
