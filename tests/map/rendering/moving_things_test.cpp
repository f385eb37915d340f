// SPDX-License-Identifier: BSD-3-Clause
// Compares maps of logs with and without moving things. With PSI_SLAM_LONG_TESTS, prints the figures of
// share/doc/psi-slam.md.
#include "map/rendering/moving_things.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "map/exports/mapped_trajectory.h"
#include "map/rendering/frame_cells.h"
#include "psi_slam/grid_map.h"
#include "psi_slam/mapper.h"
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
  int unknowable_kept = 0;
  int walls = 0;  ///< cells that are obstacles without moving things, too
  int walls_kept = 0;

  void add(const Kept& more) {
    moving += more.moving;
    moving_kept += more.moving_kept;
    unknowable += more.unknowable;
    unknowable_kept += more.unknowable_kept;
    walls += more.walls;
    walls_kept += more.walls_kept;
  }
  double gone() const { return 1 - static_cast<double>(moving_kept) / moving; }
  double gone_of_all() const {
    return 1 - static_cast<double>(moving_kept + unknowable_kept) / (moving + unknowable);
  }
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
  bool is_seen_free = false;  ///< whether beams crossed it and ended beyond, over a second before or after
};
using EndsOfCells = std::map<std::pair<std::int64_t, std::int64_t>, Ends>;

std::pair<std::int64_t, std::int64_t> cell_of(double x, double y, double resolution_m) {
  return {std::llround(std::floor(x / resolution_m)), std::llround(std::floor(y / resolution_m))};
}

EndsOfCells ends_of(const PairOfLogs& logs, double resolution_m) {
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
                       map_T_laser.y + static_cast<double>(range_m) * std::sin(angle), resolution_m);
      };
      if (std::isfinite(still_m)) ends[end(still_m)].still = true;
      if (!(moving_m < still_m)) continue;
      Ends& stopped = ends[end(moving_m)];
      stopped.first_s = std::min(stopped.first_s, seconds(logs.moving[i].time_us));
      stopped.last_s = std::max(stopped.last_s, seconds(logs.moving[i].time_us));
    }
  }
  FrameCellFinder finder({}, resolution_m);
  for (std::size_t i = 0; i < logs.moving.size(); ++i) {
    const double time_s = seconds(logs.moving[i].time_us);
    Frame short_of_ends = logs.moving[i];  // noise lets a beam that ends on a thing cross some of its cells
    for (float& range_m : short_of_ends.scan.ranges_m)
      if (std::isfinite(range_m)) range_m = std::max(0.05F, range_m - 0.2F);
    const FrameCells& found = finder.find(short_of_ends, logs.map_T_robot[i]);
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
  return options;
}

Kept compare(const PairOfLogs& logs, double resolution_m) {
  GridMapOptions everything;
  everything.keep_moving = true;
  everything.resolution_m = resolution_m;
  GridMapOptions clean = without_moving_things();
  clean.resolution_m = resolution_m;
  const auto all = draw_grid_map(logs.moving, logs.map_T_robot, everything);
  const auto still = draw_grid_map(logs.still, logs.map_T_robot, everything);
  const auto map = draw_grid_map(logs.moving, logs.map_T_robot, clean);
  EndsOfCells ends = ends_of(logs, resolution_m);
  Kept kept;
  for (unsigned row = 0; row < all->getSizeY(); ++row)
    for (unsigned column = 0; column < all->getSizeX(); ++column) {
      const float x = all->idx2x(column);
      const float y = all->idx2y(row);
      if (!is_occupied(*all, x, y)) continue;
      const bool is_kept = is_occupied(*map, x, y);
      const Ends& end = ends[cell_of(static_cast<double>(x), static_cast<double>(y), resolution_m)];
      if (is_occupied(*still, x, y)) {
        ++kept.walls;
        kept.walls_kept += is_kept ? 1 : 0;
      } else if (end.last_s > 0 && !end.still && !end.is_seen_free) {
        ++kept.unknowable;
        kept.unknowable_kept += is_kept ? 1 : 0;
      } else if (end.last_s > 0 && !end.still) {
        ++kept.moving;
        kept.moving_kept += is_kept ? 1 : 0;
      }
    }
  return kept;
}

/// People who stand in corridors for 10 s to 60 s each.
class StandingPeople {
 public:
  StandingPeople(const FloorPlan& plan, std::size_t count, double duration_s, std::uint64_t seed) {
    SimulationRandom random(seed, SimulationRandom::Stream::kPeople, 2);
    for (std::size_t i = 0; i < count; ++i) {
      const Corridor& corridor = plan.corridors[random.index(plan.corridors.size())];
      const TPoint2D way = corridor.to - corridor.from;
      const TPoint2D across = TPoint2D(-way.y, way.x) * (1 / std::hypot(way.x, way.y));
      const double along = random.between(0, 1);
      const double aside_m = random.between(-1, 1) * (corridor.width_m / 2 - 0.3);
      const double from_s = random.between(0, 0.9) * duration_s;
      people_.push_back(
          {corridor.from + way * along + across * aside_m, from_s, from_s + random.between(10, 60)});
    }
  }

  /// Adds those who stand there at a time and make way for the robot.
  void add(double time_s, const TPose2D& world_T_robot, TrafficNow& now) const {
    constexpr double kWay_m = 0.6;
    for (const Person& person : people_)
      if (time_s >= person.from_s && time_s <= person.until_s &&
          std::hypot(person.at.x - world_T_robot.x, person.at.y - world_T_robot.y) > kWay_m)
        now.people.push_back(person.at);
  }

 private:
  struct Person {
    TPoint2D at;
    double from_s = 0;
    double until_s = 0;
  };
  std::vector<Person> people_;
};

struct DriveOptions {
  std::uint64_t seed = 1;
  double path_m = 120;
  double noise_m = 0.01;  ///< standard deviation of ranges
  std::size_t beams = 271;
  double field_of_view_rad = 1.5 * M_PI;
};

/// Drives through a random building among people, carts, doors and an operator.
PairOfLogs drive(const DriveOptions& options) {
  FloorPlanOptions plan_options;
  plan_options.seed = options.seed;
  plan_options.corridors_m = options.path_m / 3;
  const FloorPlan plan = draw_floor_plan(plan_options);
  RobotPathOptions path_options;
  path_options.seed = options.seed;
  path_options.path_m = options.path_m;
  TrafficOptions traffic_options;
  traffic_options.seed = options.seed;
  traffic_options.duration_s = options.path_m / path_options.max_speed_m_s;
  traffic_options.people = 8;
  traffic_options.carts = 10;
  traffic_options.doors = true;
  traffic_options.has_operator = true;
  const Traffic traffic(plan, traffic_options);
  const StandingPeople standing(plan, static_cast<std::size_t>(options.path_m / 8),
                                traffic_options.duration_s, options.seed);
  ScanSimulatorOptions scan;
  scan.seed = options.seed;
  scan.field_of_view_rad = options.field_of_view_rad;
  scan.beams = options.beams;
  scan.noise_m = options.noise_m;
  Recorder recorder(plan, scan, options.seed);
  RobotPath path(plan, path_options);
  while (const std::optional<PathPose> pose = path.next()) {
    TrafficNow now = traffic.at(pose->time_s, pose->world_T_robot);
    standing.add(pose->time_s, pose->world_T_robot, now);
    recorder.record(pose->time_s, pose->world_T_robot, now);
  }
  return recorder.logs;
}

/// Replaces the poses by those of a map of the log with moving things, without odometry errors.
void map_with_people(PairOfLogs& logs) {
  Mapper mapper;
  for (std::size_t i = 0; i < logs.moving.size(); ++i) {
    Frame frame = logs.moving[i];
    frame.index = i;
    frame.odom_T_robot = logs.map_T_robot[i];
    mapper.add(frame);
  }
  logs.map_T_robot = mapped_poses(mapper.finish());
}

struct Building {
  DriveOptions drive;
  double resolution_m = 0.05;
  double least_gone = 0;  ///< share of the cells of moving things that were seen free as well
};

class MovingThingsInABuilding : public testing::TestWithParam<Building> {};

TEST_P(MovingThingsInABuilding, vanish_and_walls_stay) {
  const Kept kept = compare(drive(GetParam().drive), GetParam().resolution_m);
  EXPECT_GT(kept.moving, 50);
  EXPECT_GT(kept.walls, 500);
  EXPECT_GE(kept.gone(), GetParam().least_gone) << kept.moving_kept << " of " << kept.moving;
  EXPECT_LE(kept.lost(), 0.0005) << kept.walls - kept.walls_kept << " of " << kept.walls;
}

INSTANTIATE_TEST_SUITE_P(Seeds, MovingThingsInABuilding,
                         testing::Values(Building{{1, 120, 0.01}, 0.05, 0.82},
                                         Building{{2, 120, 0.03}, 0.1, 0.9},
                                         Building{{3, 120, 0.05}, 0.05, 0.95},
                                         Building{{2, 120, 0.03}, 0.025, 0.8}));

TEST(MovingThings, figures_of_the_page) {
  if (std::getenv("PSI_SLAM_LONG_TESTS") == nullptr) GTEST_SKIP() << "takes minutes: set PSI_SLAM_LONG_TESTS";
  for (const double noise_m : {0.01, 0.03, 0.05})
    for (const bool is_mapped : {false, true}) {
      std::map<double, Kept> kept;
      for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        PairOfLogs logs = drive({seed, 120, noise_m});
        if (is_mapped) map_with_people(logs);
        for (const double resolution_m : {0.05, 0.1}) kept[resolution_m].add(compare(logs, resolution_m));
      }
      for (const auto& [resolution_m, sum] : kept) {
        std::printf(
            "noise %.2f m, poses %s, cells of %.2f m: %.1f %% of %d cells gone, %.1f %% of all %d; %.2f %% "
            "of %d wall cells lost\n",
            noise_m, is_mapped ? "of a map" : "with noise", resolution_m, 100 * sum.gone(), sum.moving,
            100 * sum.gone_of_all(), sum.moving + sum.unknowable, 100 * sum.lost(), sum.walls);
        EXPECT_LE(sum.lost(), 0.005);
      }
    }
}

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

TEST_F(MovingThingsInARoom, an_operator_who_walks_beside_the_robot_leaves_no_trail) {
  for (int i = 0; i < 110; ++i, time_s_ += 0.2) {
    const TPose2D pose(0.05 * i, 0, 0);
    const double stride_m = 0.15 * std::sin(2 * M_PI * 0.9 * time_s_);
    recorder_.record(time_s_, pose, {{pose.composePoint({0.5 + stride_m, 0.65})}, {}}, 1);
  }
  GridMapOptions everything;
  everything.keep_moving = true;
  bool is_trail = false;
  for (double x = 1.25; x < 5; x += 0.25) {  // few scans see the start free between the steps
    const TPoint2D step(x, 0.65);
    is_trail = is_trail || shows(step, 0.2, everything);
    EXPECT_FALSE(shows(step, 0.2)) << x;
  }
  EXPECT_TRUE(is_trail);
  drive();
  for (double x = 0.5; x < 5.5; x += 0.25)
    EXPECT_FALSE(shows({x, 0.65}, 0.2)) << x << " after a second visit";
}

TEST_F(MovingThingsInARoom, a_door_that_opened_vanishes_up_to_its_frame) {
  plan_.segments.push_back({{3, -3}, {3, -0.5}, Material::kWall});
  plan_.segments.push_back({{3, 0.5}, {3, 3}, Material::kWall});
  const TrafficNow closed{{}, {{{3, -0.5}, {3, 0.5}, Material::kFurniture}}};
  for (int i = 0; i < 100; ++i, time_s_ += 0.2) recorder_.record(time_s_, {0.01 * i, 0, 0}, closed, 1);
  for (int i = 0; i < 100; ++i, time_s_ += 0.2) recorder_.record(time_s_, {1 + 0.04 * i, 0, 0}, {}, 1);
  for (double y = -0.4; y <= 0.41; y += 0.1) EXPECT_FALSE(shows({3, y}, 0.04)) << y;
  for (const double y : {-1.5, -1.0, -0.6, 0.6, 1.0, 1.5}) EXPECT_TRUE(shows({3, y}, 0.06)) << y;
}

TEST_F(MovingThingsInARoom, thin_poles_stay) {
  drive();
  park(60, {});
  drive();
  for (const TPoint2D& pole : poles_) EXPECT_TRUE(shows(pole, 0.06)) << pole.x << ' ' << pole.y;
}

TEST_F(MovingThingsInARoom, a_person_vanishes_without_times_of_the_scans) {
  park(20, {person_});
  drive();
  for (Frame& frame : recorder_.logs.moving) frame.time_us = 0;
  EXPECT_FALSE(shows(person_, 0.3));
}

TEST_F(MovingThingsInARoom, a_person_close_to_a_wall_vanishes) {
  const TPoint2D beside_wall{3, -2.7};  // 0.1 m of space between the person and the wall
  park(30, {beside_wall});
  EXPECT_TRUE(shows(beside_wall + TPoint2D(0, 0.1), 0.1));
  drive();
  EXPECT_FALSE(shows(beside_wall + TPoint2D(0, 0.1), 0.1));
}

}  // namespace
}  // namespace psi_slam
