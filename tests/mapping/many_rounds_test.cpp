// SPDX-License-Identifier: BSD-3-Clause
// Tests that the work and the memory of mapping do not grow with the number of rounds through a building.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "local_maps/simulated_drive.h"
#include "logs/frames/discarded_ranges.h"
#include "mapping/loop_closure/keyframe_store.h"
#include "mapping/loop_closure/superseded_maps.h"
#include "mapping/mapper_options.h"
#include "psi_slam/mapper.h"

namespace psi_slam {
namespace {

constexpr int kRounds = 12;

// Rounds through the corridor of the simulated office.
const SimulatedDrive& rounds() {
  static const SimulatedDrive drive = [] {
    std::vector<mrpt::math::TPoint2D> corners{{1.6, 1.6}};
    for (int round = 0; round < kRounds; ++round)
      for (const mrpt::math::TPoint2D& corner :
           std::vector<mrpt::math::TPoint2D>{{18.3, 1.6}, {18.3, 12.4}, {1.6, 12.4}, {1.6, 1.6}})
        corners.push_back(corner);
    OdometryErrors errors;
    errors.length_factor = 0.98;
    errors.turn_share = 0.05;
    return drive_along(office_floor(), path_along(corners, 0.3, 0.25), errors, 5);
  }();
  return drive;
}

TEST(ManyRounds, keep_the_scans_of_the_last_rounds_and_the_accuracy_of_all) {
  const SimulatedDrive& drive = rounds();
  Mapper mapper;
  std::set<std::size_t> superseded;
  mapper.set_superseded_observer([&](std::size_t frame, const Frame& scan) {
    EXPECT_EQ(scan.scan.ranges_m.size(), drive.frames[frame].scan.ranges_m.size()) << "still whole";
    EXPECT_TRUE(superseded.insert(frame).second) << "told once";
  });
  for (const Frame& frame : drive.frames) mapper.add(frame);
  mapper.wait();
  const std::size_t of_round = drive.frames.size() / kRounds;
  std::size_t kept_maps = 0;
  for (const PlacedLocalMap& map : mapper.keyframes().local_maps)
    if (!map.is_superseded) ++kept_maps;
  EXPECT_LE(kept_maps * kRounds, mapper.keyframes().local_maps.size() * (kLaterPasses + 3));

  const MappingResult result = mapper.finish();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < result.log.size(); ++i) {
    EXPECT_EQ(has_ranges(result.log[i]), superseded.count(i) == 0) << i;
    if (has_ranges(result.log[i])) ++kept;
  }
  EXPECT_LE(kept, (kLaterPasses + 3) * of_round);
  EXPECT_GE(kept, kLaterPasses * of_round) << "each place keeps the last passes";

  // The attempts of a round do not grow once the first scans are superseded.
  const auto attempts_of = [&](int round) {
    int attempts = 0;
    for (std::size_t i = static_cast<std::size_t>(round) * of_round;
         i < static_cast<std::size_t>(round + 1) * of_round; ++i)
      attempts += result.frames[i].loops_tried;
    return attempts;
  };
  EXPECT_GT(attempts_of(7), 100);
  EXPECT_LE(attempts_of(kRounds - 1), attempts_of(7) * 5 / 4);

  double worst_m = 0;
  for (std::size_t i = 0; i < result.frames.size(); ++i) {
    const mrpt::math::TPose2D off = result.frames[i].map_T_robot - drive.map_T_robot[i];
    worst_m = std::max(worst_m, off.norm());
  }
  EXPECT_LE(worst_m, 0.1);
}

}  // namespace
}  // namespace psi_slam
