// SPDX-License-Identifier: BSD-3-Clause
#include "map/rendering/standing_views.h"

#include <gtest/gtest.h>
#include <mrpt/math/TPoint2D.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "logs/frames/discarded_ranges.h"
#include "psi_slam/grid_map.h"
#include "simulated_room.h"

namespace psi_slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kRate_hz = 5;
const SimulatedRoom kRoom{-2, 6, -2, 3};
const TPose2D kPlace(1, 0.5, 0.2);

struct StandingLog {
  std::vector<Frame> log;
  std::vector<TPose2D> map_T_robot;

  void add(const TPose2D& pose, const std::function<float(std::size_t beam)>& nearest = nullptr) {
    static const BeamBearings bearings = even_bearings(-2.3, 2.3, 541);
    Frame frame = kRoom.scan_from(pose, bearings);
    frame.time_us = static_cast<TimeUs>(1e6 / kRate_hz) * static_cast<TimeUs>(log.size());
    for (std::size_t beam = 0; nearest && beam < bearings->size(); ++beam)
      frame.scan.ranges_m[beam] = std::min(frame.scan.ranges_m[beam], nearest(beam));
    log.push_back(std::move(frame));
    map_T_robot.push_back(pose);
  }
};

/// A robot that stands for `duration_s` seconds. Somebody covers the beams 200 to 230 at a range of 2 m from
/// `from_s` to `to_s`.
StandingLog standing_log(double duration_s, double from_s, double to_s) {
  StandingLog standing;
  for (double time_s = 0; time_s < duration_s; time_s += 1 / kRate_hz)
    standing.add(kPlace, [&](std::size_t beam) {
      return time_s >= from_s && time_s < to_s && beam >= 200 && beam <= 230 ? 2.0F : 1000.0F;
    });
  return standing;
}

/// Returns whether the map has an obstacle 2 m from the laser in beam 215.
bool shows_visitor(const StandingLog& standing) {
  const auto grid = draw_grid_map(standing.log, standing.map_T_robot);
  const double bearing = static_cast<double>((*standing.log[0].scan.bearings_rad)[215]);
  const TPoint2D place = (kPlace + TPose2D(0.1, 0, bearing)).composePoint({2.0, 0});
  bool any = false;
  for (const double dx : {-0.05, 0.0, 0.05})
    for (const double dy : {-0.05, 0.0, 0.05})
      any = any || grid->getPos(static_cast<float>(place.x + dx), static_cast<float>(place.y + dy)) < 0.4F;
  return any;
}

TEST(StandingViews, spans_are_long_enough_and_at_one_place) {
  StandingLog log;
  for (int scan = 0; scan < 30; ++scan) log.add({0.1 * scan, 0, 0});
  for (int scan = 0; scan < 60; ++scan) log.add({3 + (scan % 2 == 0 ? 0.005 : 0), 0, 0.001 * (scan % 3)});
  for (int scan = 0; scan < 45; ++scan) log.add({4, 0, 0});
  const auto spans = standing_spans(log.log, log.map_T_robot);
  ASSERT_EQ(spans.size(), 1U);
  EXPECT_EQ(spans[0].begin, 30U);
  EXPECT_EQ(spans[0].end, 90U);
}

TEST(StandingViews, a_gap_in_time_ends_a_span) {
  StandingLog log = standing_log(30, 0, 0);
  for (std::size_t scan = 50; scan < log.log.size(); ++scan) log.log[scan].time_us += 6'000'000;
  const auto spans = standing_spans(log.log, log.map_T_robot);
  ASSERT_EQ(spans.size(), 1U);
  EXPECT_EQ(spans[0].begin, 50U);
}

TEST(StandingViews, are_evenly_spread_in_time_and_have_ranges) {
  StandingLog log = standing_log(200, 0, 0);
  for (std::size_t scan = 100; scan < 900; ++scan)
    if (scan % 100 != 0) discard_ranges(log.log[scan]);
  const auto views = standing_views(log.log, {0, log.log.size()});
  ASSERT_EQ(views.size(), 64U);
  for (std::size_t i = 0; i < views.size(); ++i) {
    EXPECT_TRUE(has_ranges(views[i].frame));
    const double middle = (static_cast<double>(i) + 0.5) / 64 * 1000;
    EXPECT_LE(static_cast<double>(views[i].index), middle);
    EXPECT_GE(static_cast<double>(views[i].index), middle - 103);
  }
  EXPECT_EQ(standing_views(log.log, {0, 55}).size(), 55U);
}

TEST(StandingViews, visitors_are_not_drawn) {
  EXPECT_FALSE(shows_visitor(standing_log(60, 0, 45)));
  EXPECT_FALSE(shows_visitor(standing_log(60, 10, 60)));
  EXPECT_FALSE(shows_visitor(standing_log(600, 100, 500)));
  EXPECT_TRUE(shows_visitor(standing_log(60, 0, 60))) << "nobody can tell this person from a post";
}

TEST(StandingViews, a_visitor_who_leaves_before_the_robot_drives_on_is_outvoted) {
  StandingLog standing = standing_log(600, 0, 600);
  EXPECT_TRUE(shows_visitor(standing));
  for (int scan = 0; scan < 300; ++scan) standing.add({1 + 0.03 * (1 + scan % 10), 0.5, 0.2});
  EXPECT_FALSE(shows_visitor(standing)) << "many scans see the floor there";
}

TEST(StandingViews, walls_stay_with_noise_of_ranges) {
  StandingLog log;
  std::mt19937_64 random(2);
  std::normal_distribution<float> noise(0, 0.03F);
  for (int scan = 0; scan < 300; ++scan) {
    log.add(kPlace);
    for (float& range_m : log.log.back().scan.ranges_m) range_m += noise(random);
  }
  for (const StandingView& view : standing_views(log.log, {0, log.log.size()}))
    for (const float range_m : view.frame.scan.ranges_m) ASSERT_TRUE(std::isfinite(range_m));
}

TEST(StandingViews, scans_of_other_shapes_are_compared_among_themselves) {
  StandingLog log = standing_log(20, 0, 0);
  for (std::size_t scan = 0; scan < log.log.size(); scan += 2) {
    log.log[scan].scan.ranges_m.resize(540);
    log.log[scan].scan.bearings_rad = even_bearings(-2.3, 2.29, 540);
    log.log[scan].companions.push_back({log.log[1].scan, log.log[scan].time_us, {}});
    log.log[scan].companions.back().scan.laser = 1;
  }
  EXPECT_EQ(standing_views(log.log, {0, log.log.size()}).size(), 64U);
}

}  // namespace
}  // namespace psi_slam
