// SPDX-License-Identifier: BSD-3-Clause
// Compares what other programs measure in the files of a map with the simulated room.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "map/exports/map_files.h"
#include "simulated_room.h"

namespace psi_slam {

/// Expects the room's x_min, x_max, y_min and y_max, in metres, at the beginning of `numbers`.
inline void expect_room(const std::vector<double>& numbers, const SimulatedRoom& room, double tolerance_m) {
  EXPECT_NEAR(numbers[0], room.x_min, tolerance_m);
  EXPECT_NEAR(numbers[1], room.x_max, tolerance_m);
  EXPECT_NEAR(numbers[2], room.y_min, tolerance_m);
  EXPECT_NEAR(numbers[3], room.y_max, tolerance_m);
}

/// Returns a place on the earth where the map's x axis points north and its y axis west.
inline GeoReference x_axis_to_the_north(int epsg) {
  return {epsg, 500'000, 5'400'000, M_PI / 2};
}

/// Expects the room at x_axis_to_the_north(): its least and largest easting and northing, in metres, at the
/// beginning of `numbers`.
inline void expect_room_with_x_axis_to_the_north(const std::vector<double>& numbers,
                                                 const SimulatedRoom& room, double tolerance_m) {
  EXPECT_NEAR(numbers[0], 500'000 - room.y_max, tolerance_m);
  EXPECT_NEAR(numbers[1], 500'000 - room.y_min, tolerance_m);
  EXPECT_NEAR(numbers[2], 5'400'000 + room.x_min, tolerance_m);
  EXPECT_NEAR(numbers[3], 5'400'000 + room.x_max, tolerance_m);
}

}  // namespace psi_slam
