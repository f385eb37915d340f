// SPDX-License-Identifier: BSD-3-Clause
// Maps a real log in which the laser sees the robot's own body, with and without the mask.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "frames/body_masked_source.h"
#include "psi_slam/grid_map.h"
#include "psi_slam/mapper.h"
#include "psi_slam/open_log.h"
#include "robot_body.h"
#include "shared_logs.h"

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;
using mrpt::math::TPose2D;

struct Map {
  std::vector<TPose2D> map_T_robot;
  COccupancyGridMap2D::Ptr grid;
};

Map map_of(FrameSource& source) {
  Mapper mapper;
  while (auto frame = source.next()) mapper.add(*std::move(frame));
  const MappingResult result = mapper.finish();
  Map map;
  for (const FrameRecord& frame : result.frames) map.map_T_robot.push_back(frame.map_T_robot);
  map.grid = draw_grid_map(result.log, map.map_T_robot);
  return map;
}

bool is_occupied(const COccupancyGridMap2D& grid, double x_m, double y_m) {
  return grid.getPos(static_cast<float>(x_m), static_cast<float>(y_m)) < 0.5F;
}

struct OccupiedCells {
  std::size_t all = 0;
  std::size_t ghosts = 0;  ///< with no occupied cell of the other map within 0.1 m
};

OccupiedCells compare(const COccupancyGridMap2D& grid, const COccupancyGridMap2D& clean) {
  OccupiedCells cells;
  const auto step_m = static_cast<double>(grid.getResolution());
  for (int ix = 0; ix < static_cast<int>(grid.getSizeX()); ++ix) {
    for (int iy = 0; iy < static_cast<int>(grid.getSizeY()); ++iy) {
      if (grid.getCell(ix, iy) >= 0.5F) continue;
      ++cells.all;
      const auto x_m = static_cast<double>(grid.idx2x(ix));
      const auto y_m = static_cast<double>(grid.idx2y(iy));
      bool is_known = false;
      for (int dx = -2; dx <= 2; ++dx)
        for (int dy = -2; dy <= 2; ++dy)
          is_known = is_known || is_occupied(clean, x_m + dx * step_m, y_m + dy * step_m);
      if (!is_known) ++cells.ghosts;
    }
  }
  return cells;
}

TEST(RobotBodyInALog, leaves_no_ghosts_in_the_map) {
  const auto path = shared_file("mit-csail.clf.gz");
  if (!path) GTEST_SKIP() << kNeedsData;
  LogOptions options;
  options.beam_angles = BeamAngles::kCentredStepInclusive;
  options.max_range_m = 50;
  const auto open = [&](bool mask, bool with_body) -> std::unique_ptr<FrameSource> {
    options.mask_own_body = mask;
    std::unique_ptr<FrameSource> log = open_log(*path, options);
    if (with_body) log = std::make_unique<SeesRobotBody>(std::move(log));
    return log;
  };
  const Map clean = map_of(*open(false, false));
  const Map unmasked = map_of(*open(false, true));
  BodyMaskedSource source(open(false, true));
  const Map masked = map_of(source);

  const OccupiedCells with_ghosts = compare(*unmasked.grid, *clean.grid);
  EXPECT_GT(with_ghosts.ghosts, with_ghosts.all / 50) << "without the mask, the body is in the map";
  const OccupiedCells without_ghosts = compare(*masked.grid, *clean.grid);
  EXPECT_LE(without_ghosts.ghosts, without_ghosts.all / 1000);
  RecordProperty("ghosts_unmasked", std::to_string(with_ghosts.ghosts));
  RecordProperty("ghosts_masked", std::to_string(without_ghosts.ghosts));
  RecordProperty("occupied_cells", std::to_string(without_ghosts.all));

  ASSERT_EQ(masked.map_T_robot.size(), clean.map_T_robot.size());
  double sum_m = 0;
  double largest_m = 0;
  for (std::size_t i = 0; i < clean.map_T_robot.size(); ++i) {
    const TPose2D off = masked.map_T_robot[i] - clean.map_T_robot[i];
    sum_m += std::hypot(off.x, off.y);
    largest_m = std::max(largest_m, std::hypot(off.x, off.y));
  }
  const double mean_m = sum_m / static_cast<double>(clean.map_T_robot.size());
  RecordProperty("mean_mm", std::to_string(1e3 * mean_m));
  RecordProperty("largest_mm", std::to_string(1e3 * largest_m));
  EXPECT_LT(mean_m, 0.01);
  EXPECT_LT(largest_m, 0.05);

  const std::unique_ptr<FrameSource> opened = open(true, false);
  EXPECT_EQ(map_of(*opened).map_T_robot, clean.map_T_robot) << "the mask leaves a clean log as it is";
}

}  // namespace
}  // namespace psi_slam
