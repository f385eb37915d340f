// SPDX-License-Identifier: BSD-3-Clause
// Maps a real log in which the laser sees the robot's own body, with and without the mask.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "logs/frames/body_masked_source.h"
#include "map/trajectory/relations_metric.h"
#include "psi_slam/grid_map.h"
#include "psi_slam/mapper.h"
#include "psi_slam/open_log.h"
#include "robot_body.h"
#include "shared_logs.h"

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;
using mrpt::math::TPose2D;

constexpr std::size_t kScans = 2500;  ///< number of scans that are mapped

struct Map {
  std::vector<Frame> log;
  std::vector<TPose2D> map_T_robot;
  COccupancyGridMap2D::Ptr grid;
};

Map map_of(FrameSource& source) {
  Mapper mapper;
  for (std::size_t i = 0; i < kScans; ++i) mapper.add(source.next().value());
  MappingResult result = mapper.finish();
  Map map;
  for (const FrameRecord& frame : result.frames) map.map_T_robot.push_back(frame.map_T_robot);
  GridMapOptions everything;
  everything.keep_moving = true;  // the ghosts of a body would vanish with other moving things
  map.grid = draw_grid_map(result.log, map.map_T_robot, everything);
  map.log = std::move(result.log);
  return map;
}

/// Number of occupied cells within 0.3 m of the path, where the robot drove.
std::size_t occupied_on_path(const Map& map) {
  const COccupancyGridMap2D& grid = *map.grid;
  constexpr int kReach = 6;  // cells of 5 cm
  std::set<std::pair<int, int>> occupied;
  for (const TPose2D& pose : map.map_T_robot) {
    const int x = grid.x2idx(pose.x);
    const int y = grid.y2idx(pose.y);
    for (int dx = -kReach; dx <= kReach; ++dx)
      for (int dy = -kReach; dy <= kReach; ++dy)
        if (std::hypot(dx, dy) <= kReach && grid.getCell(x + dx, y + dy) < 0.5F)
          occupied.insert({x + dx, y + dy});
  }
  return occupied.size();
}

double error_m(const Map& map, const std::filesystem::path& relations) {
  Trajectory trajectory;
  for (std::size_t i = 0; i < map.log.size(); ++i)
    trajectory.push_back({map.log[i].time_us, map.map_T_robot[i]});
  return evaluate_relations(trajectory, read_relations(relations)).translation_abs_m.mean;
}

/// Mean difference between the motions of two trajectories over 20 scans.
double mean_difference_m(const Map& a, const Map& b) {
  constexpr std::size_t kApart = 20;
  double sum_m = 0;
  for (std::size_t i = kApart; i < a.map_T_robot.size(); ++i) {
    const TPose2D off =
        (a.map_T_robot[i] - a.map_T_robot[i - kApart]) - (b.map_T_robot[i] - b.map_T_robot[i - kApart]);
    sum_m += std::hypot(off.x, off.y);
  }
  return sum_m / static_cast<double>(a.map_T_robot.size() - kApart);
}

TEST(RobotBodyInALog, leaves_no_ghosts_in_the_map) {
  const auto path = shared_file("aces.clf.gz");
  const auto relations = shared_file("aces.relations");
  if (!path || !relations) GTEST_SKIP() << kNeedsData;
  LogOptions options;
  options.mask_own_body = false;
  const auto log_with_body = [&] { return std::make_unique<SeesRobotBody>(open_log(*path, options)); };
  const Map clean = map_of(*open_log(*path, options));
  const Map unmasked = map_of(*log_with_body());
  BodyMaskedSource source(log_with_body());
  const Map masked = map_of(source);

  RecordProperty("occupied_clean", std::to_string(occupied_on_path(clean)));
  RecordProperty("occupied_unmasked", std::to_string(occupied_on_path(unmasked)));
  RecordProperty("occupied_masked", std::to_string(occupied_on_path(masked)));
  RecordProperty("error_clean_mm", std::to_string(1e3 * error_m(clean, *relations)));
  RecordProperty("error_unmasked_mm", std::to_string(1e3 * error_m(unmasked, *relations)));
  RecordProperty("error_masked_mm", std::to_string(1e3 * error_m(masked, *relations)));
  RecordProperty("difference_mm", std::to_string(1e3 * mean_difference_m(masked, clean)));
  // Other beams cross most cells in which the body was seen, so that only a few ghosts remain without the
  // mask.
  EXPECT_GE(occupied_on_path(unmasked), occupied_on_path(clean) + 5);
  EXPECT_EQ(occupied_on_path(masked), occupied_on_path(clean));
  ASSERT_EQ(masked.map_T_robot.size(), clean.map_T_robot.size());
  EXPECT_LT(mean_difference_m(masked, clean), 0.015);
  EXPECT_LT(error_m(masked, *relations), error_m(clean, *relations) + 0.002);
}

}  // namespace
}  // namespace psi_slam
