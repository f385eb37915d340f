// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/local_maps/local_map.h"

#include <gtest/gtest.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/poses/CPose3D.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <random>
#include <utility>

#include "mapping/local_maps/scan_filter.h"
#include "simulated_drive.h"

namespace psi_slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

// Options without smoothing, so the score of a cell is its evidence.
LocalMapOptions without_smoothing() {
  LocalMapOptions options;
  options.smoothing_sigma_m = 1e-4;
  return options;
}

// Options with which one hit is not full evidence.
LocalMapOptions with_weak_hits() {
  LocalMapOptions options = without_smoothing();
  options.hit_probability = 0.56;
  return options;
}

// Centre of a cell with a side of 5 cm.
TPoint2D middle(int x, int y) {
  return {0.05 * x + 0.025, 0.05 * y + 0.025};
}

Beams beam(const TPoint2D& origin, const TPoint2D& end, bool hit = true) {
  return {origin, {end}, {hit}};
}

Beams operator+(Beams a, const Beams& b) {
  a.ends.insert(a.ends.end(), b.ends.begin(), b.ends.end());
  a.hits.insert(a.hits.end(), b.hits.begin(), b.hits.end());
  return a;
}

int score_at(const ScoreGrid& grid, const TPoint2D& point) {
  const auto index = [&](double v, double origin) {
    return static_cast<int>(std::floor((v - origin) / grid.resolution_m()));
  };
  return grid.finest().at(index(point.x, grid.origin_x_m()), index(point.y, grid.origin_y_m()));
}

ScanPoints points_at(const std::vector<TPoint2D>& places) {
  ScanPoints scan;
  for (const TPoint2D& place : places)
    scan.points.emplace_back(static_cast<float>(place.x), static_cast<float>(place.y));
  return scan;
}

std::size_t observed(const LocalMap& map, const TPoint2D& place) {
  return map.agreement(points_at({place}), {0, 0, 0}).observed;
}

Beams square_room_scan(double half_side_m, const TPose2D& map_T_robot, int beams = 361) {
  SimulatedWalls room;
  room.add_box(-half_side_m, -half_side_m, half_side_m, half_side_m);
  std::mt19937_64 random(1);
  const LaserScan scan = simulated_scan(
      room, map_T_robot, even_bearings(-M_PI, M_PI * (1 - 2.0 / beams), beams), {0, 0, 0}, 0, random);
  return drawing_beams(scan, map_T_robot, {40});
}

TEST(LocalMap, hits_are_occupied_beams_are_free_the_rest_is_unknown) {
  LocalMap map(without_smoothing());
  map.insert(beam(middle(0, 0), middle(40, 0)));
  const ScoreGrid& scores = map.scores();
  EXPECT_GT(score_at(scores, middle(40, 0)), 0);
  for (int x = 0; x < 40; ++x) {
    EXPECT_EQ(score_at(scores, middle(x, 0)), 0);
    EXPECT_EQ(observed(map, middle(x, 0)), 1U) << "free cells are observed";
  }
  EXPECT_EQ(observed(map, middle(40, 0)), 1U);
  for (const TPoint2D& place : {middle(41, 0), middle(-1, 0), middle(20, 1), middle(20, -1), middle(40, 1)}) {
    EXPECT_EQ(score_at(scores, place), 0);
    EXPECT_EQ(observed(map, place), 0U) << place.x << ", " << place.y;
  }
}

TEST(LocalMap, a_beam_that_was_cut_has_nothing_at_its_end) {
  LocalMap map(without_smoothing());
  map.insert(beam(middle(0, 0), middle(40, 0), false));
  EXPECT_EQ(score_at(map.scores(), middle(40, 0)), 0);
  EXPECT_EQ(observed(map, middle(39, 0)), 1U);
}

TEST(LocalMap, the_surface_between_joined_ends_is_occupied) {
  Beams beams;
  beams.origin = middle(0, 0);
  for (const int y : {-30, -10, 10, 30}) {
    beams.ends.push_back(middle(100, y));
    beams.hits.push_back(true);
  }
  beams.joined = {false, true, false, true};
  LocalMap map(without_smoothing());
  map.insert(beams);
  for (int y = -30; y <= 30; ++y)
    EXPECT_EQ(score_at(map.scores(), middle(100, y)) > 0, y <= -10 || y >= 10) << y;

  beams.joined = {true, false, false, false};
  LocalMap of_full_circle(without_smoothing());
  of_full_circle.insert(beams);
  for (int y = -30; y <= 30; ++y)
    EXPECT_GT(score_at(of_full_circle.scores(), middle(100, y)), 0) << "the first end is joined to the last";
}

TEST(LocalMap, every_beam_is_a_line_without_holes_to_beside_its_end) {
  std::mt19937_64 random(2);
  std::uniform_int_distribution<int> cell(-60, 60);
  for (int trial = 0; trial < 100; ++trial) {
    const int x0 = cell(random);
    const int y0 = cell(random);
    const int x1 = cell(random);
    const int y1 = cell(random);
    if (x0 == x1 && y0 == y1) continue;
    LocalMap map(without_smoothing());
    map.insert(beam(middle(x0, y0), middle(x1, y1)));
    map.scores();
    // Cells on the path of the beam are observed. Cells farther than one cell from the path are not.
    const double length = std::hypot(x1 - x0, y1 - y0);
    for (int y = std::min(y0, y1) - 2; y <= std::max(y0, y1) + 2; ++y) {
      for (int x = std::min(x0, x1) - 2; x <= std::max(x0, x1) + 2; ++x) {
        const double across = std::abs((x - x0) * (y1 - y0) - (y - y0) * (x1 - x0)) / length;
        const double along = ((x - x0) * (x1 - x0) + (y - y0) * (y1 - y0)) / length;
        const bool on_the_way = along >= 0 && along <= length;
        if (on_the_way && across < 0.3) {
          EXPECT_EQ(observed(map, middle(x, y)), 1U) << x << ", " << y;
        } else if (across > 1.1 || along < -1.1 || along > length + 1.1) {
          EXPECT_EQ(observed(map, middle(x, y)), 0U) << x << ", " << y;
        }
      }
    }
  }
}

TEST(LocalMap, more_hits_are_more_evidence_and_passes_take_it_away) {
  LocalMap map(with_weak_hits());
  map.insert(beam(middle(0, 0), middle(40, 0)));
  const int once = score_at(map.scores(), middle(40, 0));
  map.insert(beam(middle(0, 0), middle(40, 0)));
  const int twice = score_at(map.scores(), middle(40, 0));
  EXPECT_GT(twice, once);
  map.insert(beam(middle(0, 0), middle(50, 0)));
  const int passed = score_at(map.scores(), middle(40, 0));
  EXPECT_LE(passed, twice);
  for (int i = 0; i < 8; ++i) map.insert(beam(middle(0, 0), middle(50, 0)));
  EXPECT_EQ(score_at(map.scores(), middle(40, 0)), 0) << "a door, seen closed twice and then open, is free";
}

TEST(LocalMap, in_a_scan_ends_take_precedence_over_beams) {
  const Beams hits = beam(middle(0, 0), middle(40, 0));
  const Beams passes = beam(middle(0, 0), middle(50, 0));
  LocalMap hit_only(with_weak_hits());
  hit_only.insert(hits);
  const int expected = score_at(hit_only.scores(), middle(40, 0));
  for (const Beams& scan : {hits + passes, passes + hits}) {
    LocalMap map(with_weak_hits());
    map.insert(scan);
    EXPECT_EQ(score_at(map.scores(), middle(40, 0)), expected);
    EXPECT_EQ(score_at(map.scores(), middle(50, 0)), expected);
  }
}

TEST(LocalMap, in_a_scan_a_cell_counts_once) {
  const Beams hit = beam(middle(0, 0), middle(40, 0));
  const Beams pass = beam(middle(0, 0), middle(50, 0));
  LocalMap once(with_weak_hits());
  LocalMap often(with_weak_hits());
  for (int scan = 0; scan < 2; ++scan) {
    once.insert(hit);
    often.insert(hit + hit + hit + hit);
  }
  EXPECT_EQ(score_at(often.scores(), middle(40, 0)), score_at(once.scores(), middle(40, 0)));
  once.insert(pass);
  often.insert(pass + pass + pass + pass);
  EXPECT_GT(score_at(once.scores(), middle(40, 0)), 0);
  EXPECT_EQ(score_at(often.scores(), middle(40, 0)), score_at(once.scores(), middle(40, 0)));
}

// Cells store the number of the last scan in 16 bits.
TEST(LocalMap, cells_change_again_after_65535_scans) {
  LocalMap map(with_weak_hits());
  map.insert(beam(middle(0, 0), middle(40, 0)));
  const int once = score_at(map.scores(), middle(40, 0));
  for (int i = 0; i < 65'534; ++i) map.insert(beam(middle(0, 0), middle(0, 3)));
  map.insert(beam(middle(0, 0), middle(40, 0)));
  EXPECT_GT(score_at(map.scores(), middle(40, 0)), once);
}

TEST(LocalMap, growing_keeps_what_was_drawn) {
  LocalMap map({});
  map.insert(square_room_scan(3, {0.3, 0.2, 0.4}));
  map.insert(square_room_scan(3, {-0.3, 0.5, 1.4}));
  std::map<std::pair<int, int>, int> before;
  const ScoreGrid small = map.scores();
  for (int y = -80; y < 80; ++y)
    for (int x = -80; x < 80; ++x) before[{x, y}] = score_at(small, middle(x, y));

  // Draws beams far away, outside the room, so the grid must grow.
  map.insert(beam({30, 0}, {47, 3}) + beam({30, 0}, {30, -28}));
  map.insert(beam({-25, 30}, {-38, 31}));
  const ScoreGrid& large = map.scores();
  EXPECT_GT(large.finest().width(), small.finest().width());
  EXPECT_GT(large.finest().height(), small.finest().height());
  for (const auto& [cell, score] : before)
    ASSERT_EQ(score_at(large, middle(cell.first, cell.second)), score) << cell.first << ", " << cell.second;
  EXPECT_GT(score_at(large, {47, 3}), 0);
  EXPECT_GT(score_at(large, {-38, 31}), 0);
}

TEST(LocalMap, leaves_out_a_scan_that_needs_a_grid_of_gigabytes) {
  LocalMap map(without_smoothing());
  map.insert(beam(middle(0, 0), middle(20, 0)));
  const std::size_t before_bytes = map.memory_bytes();
  const Beams near = beam(middle(0, 3), middle(20, 3));
  for (const double far_m : {2000.0, 1e7, 1e300, std::nan("")})
    map.insert({near, beam({far_m, far_m}, {far_m + 1, far_m}), beam(middle(0, 0), {far_m, -far_m})});
  map.insert(beam(middle(0, 0), {3000, 3000}));
  EXPECT_EQ(map.memory_bytes(), before_bytes) << "the grid has not grown";
  EXPECT_GT(score_at(map.scores(), middle(20, 3)), 0) << "the scan beside the far ones is drawn";
  map.insert(beam(middle(0, 0), middle(3000, 3000)));
  EXPECT_GT(score_at(map.scores(), middle(3000, 3000)), 0) << "150 m are not far";
}

// Compares the kept tables of bounds with tables that are made at once.
bool has_bounds_of_its_scores(const ScoreGrid& scores) {
  ScoreGrid fresh = scores;
  fresh.make_bounds();
  fresh.update_bounds({0, 0}, {scores.finest().width(), scores.finest().height()});
  const BoundTables* kept = scores.bounds(ScoreGrid::kBoundStrides.back(), 1, 1);
  const BoundTables* expected = fresh.bounds(ScoreGrid::kBoundStrides.back(), 1, 1);
  return kept != nullptr && kept->memory_bytes() == expected->memory_bytes() &&
         std::equal(kept->bytes(), kept->bytes() + kept->memory_bytes(), expected->bytes());
}

TEST(LocalMap, scores_follow_scan_by_scan_what_drawing_at_once_gives) {
  LocalMap step_by_step({});
  LocalMap at_once({});
  for (int i = 0; i < 30; ++i) {
    const Beams scan = square_room_scan(4, {0.1 * i, -0.05 * i, 0.2 * i}, 90);
    step_by_step.insert(scan);
    ASSERT_TRUE(has_bounds_of_its_scores(step_by_step.scores())) << "scan " << i;
    at_once.insert(scan);
  }
  const ScoreGrid& a = step_by_step.scores();
  const ScoreGrid& b = at_once.scores();
  ASSERT_EQ(a.finest().width(), b.finest().width());
  ASSERT_EQ(a.finest().height(), b.finest().height());
  for (int y = 0; y < a.finest().height(); ++y)
    for (int x = 0; x < a.finest().width(); ++x) ASSERT_EQ(a.finest().at(x, y), b.finest().at(x, y));
}

TEST(LocalMap, finishing_freezes_the_scores_and_frees_memory) {
  LocalMap map({});
  for (int i = 0; i < 5; ++i) map.insert(square_room_scan(4, {0.1 * i, 0, 0.1 * i}));
  const ScoreGrid before = map.scores();
  const std::size_t bytes_before = map.memory_bytes();
  EXPECT_FALSE(map.finished());
  EXPECT_FALSE(before.has_pyramid());
  map.finish();
  EXPECT_TRUE(map.finished());
  EXPECT_LT(map.memory_bytes(), bytes_before);
  for (int again = 0; again < 2; ++again) {
    const ScoreGrid& after = map.scores();
    EXPECT_TRUE(after.has_pyramid());
    EXPECT_LT(after.finest().memory_bytes(), before.finest().memory_bytes())
        << "cropped to the observed region";
    const long left = std::lround((after.origin_x_m() - before.origin_x_m()) / 0.05);
    const long below = std::lround((after.origin_y_m() - before.origin_y_m()) / 0.05);
    for (int y = -1; y <= before.finest().height(); ++y)
      for (int x = -1; x <= before.finest().width(); ++x)
        ASSERT_EQ(after.finest().at(x - static_cast<int>(left), y - static_cast<int>(below)),
                  before.finest().at(x, y));
    map.finish();
  }
}

TEST(LocalMap, packing_and_unpacking_restores_it) {
  const auto filled = [] {
    LocalMap map({});
    for (int i = 0; i < 5; ++i) map.insert(square_room_scan(4, {0.1 * i, 0, 0.1 * i}));
    map.pack();
    EXPECT_FALSE(map.packed()) << "the map is not finished";
    map.finish();
    return map;
  };
  const LocalMap never = filled();
  LocalMap map = filled();
  const ScanPoints scan = points_at({{1, 1}, {4, 0}, {3.9, 2}, {20, 20}});
  for (int again = 0; again < 2; ++again) {
    map.pack();
    EXPECT_TRUE(map.packed());
    EXPECT_LT(map.memory_bytes(), never.memory_bytes() / 20);
    EXPECT_THROW(map.agreement(scan, {0.1, 0, 0}), std::logic_error);
    map.unpack();
    EXPECT_FALSE(map.packed());
    const auto expect_same = [](const ScoreLevel& a, const ScoreLevel& b) {
      ASSERT_EQ(a.memory_bytes(), b.memory_bytes());
      const int margin = ScoreLevel::kMargin;
      EXPECT_EQ(std::memcmp(a.cell(-margin, -margin), b.cell(-margin, -margin), a.memory_bytes()), 0);
    };
    expect_same(map.scores().finest(), never.scores().finest());
    ASSERT_TRUE(map.scores().has_pyramid());
    for (std::size_t i = 0; i < ScoreGrid::kStrides.size(); ++i)
      expect_same(map.scores().pyramid(i), never.scores().pyramid(i));
    EXPECT_EQ(map.agreement(scan, {0.1, 0, 0}).observed, never.agreement(scan, {0.1, 0, 0}).observed);
    EXPECT_EQ(map.agreement(scan, {0.1, 0, 0}).hits, never.agreement(scan, {0.1, 0, 0}).hits);
  }
}

TEST(LocalMap, an_empty_map_can_be_finished) {
  LocalMap map({});
  map.finish();
  EXPECT_TRUE(map.scores().has_pyramid());
  EXPECT_EQ(map.agreement(points_at({{0, 0}, {1, 1}}), {0, 0, 0}).observed, 0U);
}

TEST(LocalMap, finishing_scores_what_was_inserted_last) {
  LocalMap map({});
  map.insert(square_room_scan(4, {0, 0, 0}));
  map.scores();
  map.insert(beam({0, 0}, {1, 1}) + beam({0, 0}, {1, 1}));
  map.finish();
  EXPECT_GT(score_at(map.scores(), {1, 1}), 0);
}

TEST(LocalMap, agreement_counts_points_in_observed_space_and_those_on_walls) {
  LocalMap map({});
  for (int i = 0; i < 3; ++i) map.insert(square_room_scan(3, {0, 0, 0.01 * i}));
  const ScanPoints scan = points_at({{2.99, 0},    // on the wall
                                     {0.5, 2.96},  // on another wall
                                     {1, 1},       // in free space
                                     {-2, 0.5},    // also in free space
                                     {4.5, 0},     // beyond the wall: not observed
                                     {400, 0}});   // off the grid
  for (const bool finished : {false, true}) {
    if (finished) map.finish();
    map.scores();
    const LocalMap::Agreement agreement = map.agreement(scan, {0, 0, 0});
    EXPECT_EQ(agreement.observed, 4U);
    EXPECT_EQ(agreement.hits, 2U);
    EXPECT_EQ(agreement.share(), 0.5);
  }
}

TEST(LocalMap, agreement_looks_from_the_pose) {
  LocalMap map({});
  for (int i = 0; i < 3; ++i) map.insert(square_room_scan(3, {0, 0, 0.01 * i}));
  map.finish();
  std::mt19937_64 random(3);
  SimulatedWalls room;
  room.add_box(-3, -3, 3, 3);
  const TPose2D pose(0.7, -0.4, 0.6);
  const ScanPoints scan =
      matching_points(simulated_scan(room, pose, even_bearings(-3, 3, 200), {0.1, 0, 0}, 0.01, random), {});
  EXPECT_GT(map.agreement(scan, pose).share(), 0.98);
  // Some points lie in cells that are not observed: between beams, or beyond walls because of range noise.
  EXPECT_GT(map.agreement(scan, pose).observed, 0.7 * static_cast<double>(scan.points.size()));
  EXPECT_LT(map.agreement(scan, {0.2, -0.1, 0.3}).share(), 0.5);
  EXPECT_EQ(map.agreement(scan, {100, 0, 0}).observed, 0U);
  EXPECT_EQ(map.agreement(scan, {100, 0, 0}).share(), 0);
}

TEST(LocalMap, an_empty_map_is_all_unknown) {
  LocalMap map({});
  map.insert({{0, 0}, {}, {}});
  map.finish();
  for (int y = 0; y < map.scores().finest().height(); ++y)
    for (int x = 0; x < map.scores().finest().width(); ++x) ASSERT_EQ(map.scores().finest().at(x, y), 0);
  EXPECT_EQ(map.agreement(points_at({{1, 1}}), {0, 0, 0}).observed, 0U);
}

// Compares the square room with MRPT's drawing of it: both must have the same walls and the same free space.
TEST(LocalMap, agrees_with_MRPTs_own_drawing_of_a_square_room) {
  constexpr double kHalfSide_m = 2.5;
  LocalMap ours(without_smoothing());
  mrpt::maps::COccupancyGridMap2D theirs(-5, 5, -5, 5, 0.05F);
  SimulatedWalls room;
  room.add_box(-kHalfSide_m, -kHalfSide_m, kHalfSide_m, kHalfSide_m);
  const BeamBearings bearings = even_bearings(-M_PI / 2, M_PI / 2, 541);
  std::mt19937_64 random(4);
  for (int i = 0; i < 12; ++i) {
    const TPose2D robot(0.3 * std::cos(i), 0.3 * std::sin(i), i * M_PI / 6);
    const LaserScan scan = simulated_scan(room, robot, bearings, {0, 0, 0}, 0, random);
    ours.insert(drawing_beams(scan, robot, {40}));
    mrpt::obs::CObservation2DRangeScan observation;
    observation.aperture = static_cast<float>(M_PI);
    observation.maxRange = 30;
    observation.loadFromVectors(scan.ranges_m.size(), scan.ranges_m.data(),
                                std::vector<char>(scan.ranges_m.size(), 1).data());
    theirs.insertObservation(observation, mrpt::poses::CPose3D(robot));
  }
  const ScoreGrid& scores = ours.scores();
  int walls = 0;
  int walls_shared = 0;
  int free = 0;
  int free_shared = 0;
  for (int y = -70; y < 70; ++y) {
    for (int x = -70; x < 70; ++x) {
      const TPoint2D place = middle(x, y);
      const double their_free =
          static_cast<double>(theirs.getPos(static_cast<float>(place.x), static_cast<float>(place.y)));
      if (their_free < 0.3) {
        ++walls;
        int best = 0;  // best score nearby, because MRPT's bearings are off by half a beam
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx) best = std::max(best, score_at(scores, middle(x + dx, y + dy)));
        walls_shared += best > 100;
      } else if (their_free > 0.7) {
        ++free;
        free_shared += score_at(scores, place) == 0 && observed(ours, place) == 1;
      }
    }
  }
  EXPECT_GT(walls, 300);
  EXPECT_GT(free, 9000);
  EXPECT_GT(walls_shared, 0.98 * walls);
  EXPECT_GT(free_shared, 0.98 * free);
}

TEST(LocalMap, every_laser_clears_space_from_its_own_origin) {
  // Front and rear laser, each half a metre from the robot's centre. Each laser sees one wall.
  const Beams front = beam(middle(10, 0), middle(60, 0));
  const Beams rear = beam(middle(-10, 0), middle(-60, 0));
  LocalMap map(without_smoothing());
  map.insert(std::vector<Beams>{front, rear});
  map.scores();
  EXPECT_GT(score_at(map.scores(), middle(60, 0)), 128);
  EXPECT_GT(score_at(map.scores(), middle(-60, 0)), 128);
  for (int x = 11; x < 60; ++x) {
    EXPECT_EQ(observed(map, middle(x, 0)), 1U) << x;
    EXPECT_EQ(observed(map, middle(-x, 0)), 1U) << -x;
    EXPECT_LT(score_at(map.scores(), middle(-x, 0)), 64) << -x;
  }
  for (int x = -8; x <= 8; ++x) EXPECT_EQ(observed(map, middle(x, 0)), 0U) << "not observed: " << x;
}

TEST(LocalMap, no_laser_erases_simultaneous_hits_of_another) {
  const Beams hit = beam(middle(0, 0), middle(40, 0));
  const Beams through = beam(middle(0, 1), middle(80, -1));  // crosses the cell of the hit
  LocalMap together(with_weak_hits());
  together.insert(std::vector<Beams>{hit, through});
  LocalMap alone(with_weak_hits());
  alone.insert(hit);
  EXPECT_EQ(score_at(together.scores(), middle(40, 0)), score_at(alone.scores(), middle(40, 0)));
}

}  // namespace
}  // namespace psi_slam
