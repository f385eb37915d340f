// SPDX-License-Identifier: BSD-3-Clause
#include "rendering/moving_things.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "psi_slam/grid_map.h"
#include "rendering/frame_cells.h"
#include "simulation/robot_path.h"
#include "simulation/scan_simulator.h"
#include "simulation/simulation_random.h"
#include "simulation/traffic.h"

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;
using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

/// A log of a robot among moving things, and the same log without them.
struct PairOfLogs {
  std::vector<Frame> moving;
  std::vector<Frame> still;
  std::vector<TPose2D> map_T_robot;
};

/// Scans from poses in a plan with and without things that move. The poses of the map have errors.
class Recorder {
 public:
  Recorder(const FloorPlan& plan, const ScanSimulatorOptions& options, std::uint64_t seed)
      : simulator_(plan, options), random_(seed, SimulationRandom::Stream::kOdometry) {}

  /// `errors` is a factor of the errors of the pose.
  void record(double time_s, const TPose2D& pose, const TrafficNow& traffic, double errors = 1) {
    const std::size_t index = logs.still.size();
    Frame frame;
    frame.time_us = 1'000'000'000 + static_cast<TimeUs>(std::llround(time_s * 1e6));
    frame.scan = simulator_.scan(pose, {}, index);
    logs.still.push_back(frame);
    frame.scan = simulator_.scan(pose, traffic.people, index, traffic.things);
    logs.moving.push_back(frame);
    logs.map_T_robot.push_back(pose + TPose2D(0.01 * errors * random_.normal(),
                                              0.01 * errors * random_.normal(),
                                              0.002 * errors * random_.normal()));
  }

  PairOfLogs logs;

 private:
  ScanSimulator simulator_;
  SimulationRandom random_;
};

/// The obstacles of the map of all evidence, split by what beams hit there, and those that remain without
/// moving things.
struct Kept {
  int moving = 0;       ///< cells in which only moving things stopped beams, and that were seen free as well
  int moving_kept = 0;  ///< of these, cells that are still obstacles
  int unknowable = 0;   ///< like these, but no beam crossed them at another time
  int walls = 0;        ///< cells that are obstacles without moving things, too
  int walls_kept = 0;

  double gone() const { return 1 - static_cast<double>(moving_kept) / moving; }
  double lost() const { return 1 - static_cast<double>(walls_kept) / walls; }
};

bool is_occupied(const COccupancyGridMap2D& grid, float x, float y) {
  return grid.getPos(x, y) < 0.5F;
}

/// What the beams of all scans did in a cell.
struct Ends {
  bool still = false;         ///< a beam ended there on something that never moves
  double first_s = 1e9;       ///< time of the first beam that a moving thing stopped there
  double last_s = -1e9;       ///< and of the last
  bool is_seen_free = false;  ///< whether beams crossed the cell more than a second before or after
};
using EndsOfCells = std::map<std::pair<std::int64_t, std::int64_t>, Ends>;

std::pair<std::int64_t, std::int64_t> cell_of(double x, double y) {
  return {std::llround(std::floor(x / 0.05)), std::llround(std::floor(y / 0.05))};
}

EndsOfCells ends_of(const PairOfLogs& logs) {
  EndsOfCells ends;
  for (std::size_t i = 0; i < logs.still.size(); ++i) {
    const LaserScan& still = logs.still[i].scan;
    const TPose2D map_T_laser = logs.map_T_robot[i] + still.robot_T_laser;
    for (std::size_t beam = 0; beam < still.ranges_m.size(); ++beam) {
      const float still_m = still.ranges_m[beam];
      const float moving_m = logs.moving[i].scan.ranges_m[beam];
      const auto end = [&](float range_m) {
        const double angle = map_T_laser.phi + static_cast<double>((*still.bearings_rad)[beam]);
        return cell_of(map_T_laser.x + static_cast<double>(range_m) * std::cos(angle),
                       map_T_laser.y + static_cast<double>(range_m) * std::sin(angle));
      };
      if (std::isfinite(still_m)) ends[end(still_m)].still = true;
      if (!(moving_m < still_m)) continue;
      Ends& stopped = ends[end(moving_m)];
      stopped.first_s = std::min(stopped.first_s, seconds(logs.moving[i].time_us));
      stopped.last_s = std::max(stopped.last_s, seconds(logs.moving[i].time_us));
    }
  }
  FrameCellFinder finder({}, 0.05);
  for (std::size_t i = 0; i < logs.moving.size(); ++i) {
    const double time_s = seconds(logs.moving[i].time_us);
    const FrameCells& found = finder.find(logs.moving[i], logs.map_T_robot[i]);
    for (const TouchedCell& cell : found.cells) {
      if (cell.marks != kPassed) continue;
      const auto end = ends.find({found.x_min + cell.x, found.y_min + cell.y});
      if (end != ends.end() && (time_s < end->second.first_s - 1 || time_s > end->second.last_s + 1))
        end->second.is_seen_free = true;
    }
  }
  return ends;
}

GridMapOptions without_moving_things() {
  GridMapOptions options;
  options.keep_moving = false;
  options.min_beams = 2;
  return options;
}

Kept compare(const PairOfLogs& logs) {
  GridMapOptions everything;
  everything.keep_moving = true;
  everything.min_beams = 1;
  const auto all = draw_grid_map(logs.moving, logs.map_T_robot, everything);
  const auto still = draw_grid_map(logs.still, logs.map_T_robot, everything);
  const auto map = draw_grid_map(logs.moving, logs.map_T_robot, without_moving_things());
  EndsOfCells ends = ends_of(logs);
  Kept kept;
  for (unsigned row = 0; row < all->getSizeY(); ++row)
    for (unsigned column = 0; column < all->getSizeX(); ++column) {
      const float x = all->idx2x(column);
      const float y = all->idx2y(row);
      if (!is_occupied(*all, x, y)) continue;
      const bool is_kept = is_occupied(*map, x, y);
      const Ends& end = ends[cell_of(static_cast<double>(x), static_cast<double>(y))];
      if (is_occupied(*still, x, y)) {
        ++kept.walls;
        kept.walls_kept += is_kept ? 1 : 0;
      } else if (end.last_s > 0 && !end.still && !end.is_seen_free) {
        ++kept.unknowable;
      } else if (end.last_s > 0 && !end.still) {
        ++kept.moving;
        kept.moving_kept += is_kept ? 1 : 0;
      }
    }
  return kept;
}

/// Drives through a random building.
PairOfLogs drive(std::uint64_t seed, double path_m, TrafficOptions traffic_options) {
  FloorPlanOptions plan_options;
  plan_options.seed = seed;
  plan_options.corridors_m = path_m / 3;
  const FloorPlan plan = draw_floor_plan(plan_options);
  RobotPathOptions path_options;
  path_options.seed = seed;
  path_options.path_m = path_m;
  traffic_options.seed = seed;
  traffic_options.duration_s = path_m / path_options.max_speed_m_s;
  const Traffic traffic(plan, traffic_options);
  ScanSimulatorOptions scan;
  scan.seed = seed;
  scan.field_of_view_rad = 1.5 * M_PI;
  scan.beams = 271;
  Recorder recorder(plan, scan, seed);
  RobotPath path(plan, path_options);
  while (const std::optional<PathPose> pose = path.next())
    recorder.record(pose->time_s, pose->world_T_robot, traffic.at(pose->time_s, pose->world_T_robot));
  return recorder.logs;
}

/// Expects that at least 45 % of the cells of moving things are gone and at most 0.5 % of the walls lost.
void expect_clean(const Kept& kept) {
  EXPECT_GT(kept.moving, 50);
  EXPECT_GT(kept.walls, 500);
  EXPECT_GE(kept.gone(), 0.45) << kept.moving_kept << " of " << kept.moving;
  EXPECT_LE(kept.lost(), 0.005) << kept.walls - kept.walls_kept << " of " << kept.walls;
}

class MovingThingsInABuilding : public testing::TestWithParam<std::uint64_t> {};

TEST_P(MovingThingsInABuilding, vanish_and_walls_stay) {
  TrafficOptions traffic;
  traffic.people = 6;
  traffic.carts = 8;
  traffic.doors = true;
  traffic.has_operator = true;
  expect_clean(compare(drive(GetParam(), 120, traffic)));
}

INSTANTIATE_TEST_SUITE_P(Seeds, MovingThingsInABuilding, testing::Values(1, 2, 3));

/// A room of 10 m by 6 m with thin poles, and a robot that parks in it or drives to and fro.
class MovingThingsInARoom : public testing::Test {
 protected:
  MovingThingsInARoom() {
    outline({-1, -3}, {9, 3}, Material::kWall);
    for (const TPoint2D& pole : poles_) outline(pole, pole + TPoint2D(0.03, 0.03), Material::kPillar);
    scan_.field_of_view_rad = 1.5 * M_PI;
    scan_.beams = 541;
  }

  void outline(const TPoint2D& from, const TPoint2D& to, Material material) {
    for (const auto& [a, b] :
         {std::pair(from, TPoint2D(to.x, from.y)), std::pair(TPoint2D(to.x, from.y), to),
          std::pair(to, TPoint2D(from.x, to.y)), std::pair(TPoint2D(from.x, to.y), from)})
      plan_.segments.push_back({a, b, material});
  }

  void park(double duration_s, const std::vector<TPoint2D>& people, const TPose2D& pose = {0, 0, 0}) {
    for (const double end_s = time_s_ + duration_s; time_s_ < end_s; time_s_ += 0.2)
      recorder_.record(time_s_, pose, {people, {}}, 0);
  }

  /// Drives 4 m ahead and back at 0.5 m/s.
  void drive() {
    for (int i = 0; i < 80; ++i, time_s_ += 0.2)
      recorder_.record(time_s_, {0.1 * std::min(i, 80 - i), 0, 0}, {}, 1);
  }

  bool shows(const TPoint2D& place, double radius_m,
             const GridMapOptions& options = without_moving_things()) const {
    const auto map = draw_grid_map(recorder_.logs.moving, recorder_.logs.map_T_robot, options);
    for (double x = place.x - radius_m; x <= place.x + radius_m; x += 0.05)
      for (double y = place.y - radius_m; y <= place.y + radius_m; y += 0.05)
        if (is_occupied(*map, static_cast<float>(x), static_cast<float>(y))) return true;
    return false;
  }

  const std::vector<TPoint2D> poles_{{2, 1}, {4, -1.5}, {6, 2}, {7, 0.3}};
  const TPoint2D person_{1.5, -0.8};
  FloorPlan plan_;
  ScanSimulatorOptions scan_;
  Recorder recorder_{plan_, scan_, 1};
  double time_s_ = 0;
};

TEST_F(MovingThingsInARoom, a_person_who_stood_for_ten_minutes_vanishes) {
  park(600, {person_});
  EXPECT_TRUE(shows(person_, 0.3)) << "nobody can tell this person from a post";
  drive();
  EXPECT_FALSE(shows(person_, 0.3));
  GridMapOptions everything;
  everything.keep_moving = true;
  EXPECT_TRUE(shows(person_, 0.3, everything));
}

TEST_F(MovingThingsInARoom, a_person_who_comes_later_and_stays_vanishes) {
  drive();
  park(600, {person_});
  EXPECT_FALSE(shows(person_, 0.3));
}

TEST_F(MovingThingsInARoom, an_operator_who_stops_beside_the_robot_vanishes) {
  std::vector<TPoint2D> stops;
  for (int i = 0; i < 80; ++i, time_s_ += 0.2) {
    const TPose2D pose(0.05 * i, 0, 0);
    const TPoint2D beside = pose.composePoint({0.3, 0.7});
    recorder_.record(time_s_, pose, {{beside}, {}}, 1);
    if (i % 40 != 20) continue;
    park(20, {beside}, pose);
    stops.push_back(beside);
  }
  GridMapOptions everything;
  everything.keep_moving = true;
  for (const TPoint2D& stop : stops) {
    EXPECT_TRUE(shows(stop, 0.25, everything)) << stop.x;
    EXPECT_FALSE(shows(stop, 0.25)) << stop.x;
  }
}

TEST_F(MovingThingsInARoom, thin_poles_stay) {
  drive();
  park(60, {});
  drive();
  for (const TPoint2D& pole : poles_) EXPECT_TRUE(shows(pole, 0.06)) << pole.x << ' ' << pole.y;
}

TEST_F(MovingThingsInARoom, without_times_nothing_vanishes) {
  park(20, {person_});
  drive();
  for (Frame& frame : recorder_.logs.moving) frame.time_us = 0;
  GridMapOptions everything;
  everything.keep_moving = true;
  everything.min_beams = 2;
  const auto drawn = [&](const GridMapOptions& options) {
    return draw_grid_map(recorder_.logs.moving, recorder_.logs.map_T_robot, options)->getRawMap();
  };
  EXPECT_EQ(drawn(without_moving_things()), drawn(everything));
}

}  // namespace
}  // namespace psi_slam
