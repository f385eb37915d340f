// SPDX-License-Identifier: BSD-3-Clause
// Lengths of maps of a bare corridor, which only odometry determines. No scan may make them shorter. With
// PSI_SLAM_LONG_TESTS, prints the errors in share/doc/accuracy.md.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "local_maps/simulated_drive.h"
#include "psi_slam/mapper.h"

namespace psi_slam {
namespace {

constexpr double kPath_m = 50;
constexpr double kSteps_m[] = {0.05, 0.1, 0.2, 0.3, 0.5};

// Relative error of the length of a path along a corridor, seen by beams 1° apart with a range of 30 m. The
// walls have no features. The noise of odometry adds up to less than 1 % of the path.
double length_error(double step_m, std::uint64_t seed) {
  SimulatedWalls corridor;
  corridor.add_box(0, 0, 60, 2.4);
  OdometryErrors errors;
  errors.length_share = 0.05;
  const SimulatedDrive drive =
      drive_along(corridor, path_along({{2, 1.2}, {2 + kPath_m, 1.2}}, step_m), errors, seed);
  Mapper mapper;
  for (const Frame& frame : drive.frames) mapper.add(frame);
  const MappingResult result = mapper.finish();
  return std::hypot(result.frames.back().map_T_robot.x, result.frames.back().map_T_robot.y) / kPath_m - 1;
}

TEST(BareCorridor, keeps_its_length) {
  for (const double step_m : kSteps_m)
    EXPECT_NEAR(length_error(step_m, 1), 0, step_m < 0.4 ? 0.01 : 0.02) << "a scan every " << step_m << " m";
}

TEST(BareCorridor, figures_of_the_page) {
  if (std::getenv("PSI_SLAM_LONG_TESTS") == nullptr) GTEST_SKIP() << "takes minutes: set PSI_SLAM_LONG_TESTS";
  for (const double step_m : kSteps_m) {
    std::printf("a scan every %.2f m:", step_m);
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      const double error = length_error(step_m, seed);
      std::printf(" %.1f %%", 100 * error);
      EXPECT_NEAR(error, 0, 0.05);
    }
    std::printf("\n");
  }
}

}  // namespace
}  // namespace psi_slam
