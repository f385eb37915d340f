// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/scan_alignment.h"

#include <gtest/gtest.h>

#include <limits>

#include "simulated_run.h"

namespace psi_slam {
namespace {

using mrpt::DEG2RAD;
using mrpt::math::TPose2D;

/// Two scans of the room and the true motion between them.
struct TwoScans {
  AlignableScan reference;
  AlignableScan scan;
  TPose2D motion;
};

TwoScans two_scans(const TPose2D& motion, const TPose2D& robot_T_laser = {0, 0, 0}) {
  SimulatedRun run;
  run.truth = {{2.5, 2, 0.3}, TPose2D{2.5, 2, 0.3} + motion};
  run.robot_T_laser = robot_T_laser;
  return {AlignableScan(run.scan(0)), AlignableScan(run.scan(1)), motion};
}

void expect_motion(const ScanAlignment& alignment, const TPose2D& motion) {
  EXPECT_NEAR(alignment.reference_T_scan.x, motion.x, 0.006);
  EXPECT_NEAR(alignment.reference_T_scan.y, motion.y, 0.006);
  EXPECT_NEAR(mrpt::math::wrapToPi(alignment.reference_T_scan.phi - motion.phi), 0, DEG2RAD(0.15));
  EXPECT_LT(alignment.cost_m, 0.03);
  EXPECT_GT(alignment.matched_share, 0.8);
}

TEST(ScanAlignment, finds_the_motion_from_a_zero_guess) {
  for (const TPose2D motion :
       {TPose2D{0, 0, 0}, TPose2D{0.2, 0, 0}, TPose2D{-0.15, 0.05, 0.1}, TPose2D{0, 0, -0.15}}) {
    const TwoScans scans = two_scans(motion);
    expect_motion(align_scans(scans.reference, scans.scan, TPose2D{0, 0, 0}), motion);
  }
}

TEST(ScanAlignment, returns_the_motion_of_the_robot_for_any_mount) {
  const TPose2D motion{0.1, 0.05, 0.2};
  const TwoScans scans = two_scans(motion, {0.4, -0.2, 0.5});
  expect_motion(align_scans(scans.reference, scans.scan, motion + TPose2D{0.05, -0.05, 0.03}), motion);
}

TEST(ScanAlignment, uses_the_best_of_several_guesses) {
  const TPose2D motion{0.1, 0, DEG2RAD(60.0)};
  const TwoScans scans = two_scans(motion);
  EXPECT_GT(align_scans(scans.reference, scans.scan, TPose2D{0, 0, 0}).cost_m, 0.05)
      << "the motion is too far from the guess";
  const std::vector<TPose2D> guesses{{0, 0, 0}, {0, 0, DEG2RAD(-55.0)}, {0, 0, DEG2RAD(55.0)}, {2, 0, 0}};
  const ScanAlignment best = align_scans(scans.reference, scans.scan, guesses);
  EXPECT_NEAR(best.reference_T_scan.phi, motion.phi, DEG2RAD(0.3));
  EXPECT_NEAR(best.reference_T_scan.x, motion.x, 0.01);
}

TEST(ScanAlignment, has_a_large_deviation_along_a_corridor) {
  SimulatedRun run;
  LaserScan corridor = [&] {
    LaserScan scan;
    scan.bearings_rad = std::make_shared<const std::vector<float>>(run.bearings_rad);
    for (const float bearing : run.bearings_rad) {
      const double sine = std::abs(std::sin(static_cast<double>(bearing)));
      scan.ranges_m.push_back(sine > 0.05 ? static_cast<float>(1.0 / sine)
                                          : std::numeric_limits<float>::quiet_NaN());
    }
    return scan;
  }();
  const AlignableScan scan(corridor);
  const ScanAlignment alignment = align_scans(scan, scan, TPose2D{0.1, 0, 0});
  EXPECT_GT(alignment.deviation_along_m(0), 0.1) << "along the corridor";
  EXPECT_LT(alignment.deviation_along_m(M_PI / 2), 0.005) << "across the corridor";
  EXPECT_NEAR(alignment.reference_T_scan.x, 0.1, 0.02) << "no wall determines x, so the guess is kept";

  const TwoScans room = two_scans({0.1, 0, 0});
  const ScanAlignment in_room = align_scans(room.reference, room.scan, TPose2D{0, 0, 0});
  EXPECT_LT(in_room.deviation_along_m(0), 0.01);
  EXPECT_LT(in_room.heading_deviation_rad(), DEG2RAD(0.2));
}

TEST(ScanAlignment, has_a_high_cost_for_unrelated_scans) {
  SimulatedRun run;
  run.truth = {{2.5, 2, 0.3}, {10, 7, 1.5}};
  const ScanAlignment alignment =
      align_scans(AlignableScan(run.scan(0)), AlignableScan(run.scan(1)), TPose2D{0, 0, 0});
  EXPECT_GT(alignment.cost_m, 0.06);
}

TEST(ScanAlignment, accepts_scans_without_returns) {
  SimulatedRun run;
  run.truth = {{2.5, 2, 0.3}};
  LaserScan blind = run.scan(0);
  for (float& range : blind.ranges_m) range = std::numeric_limits<float>::quiet_NaN();
  const AlignableScan empty(blind);
  EXPECT_TRUE(empty.points().empty());
  const AlignableScan full(run.scan(0));
  for (const auto& alignment :
       {align_scans(empty, full, TPose2D{0, 0, 0}), align_scans(full, empty, TPose2D{0, 0, 0})}) {
    EXPECT_EQ(alignment.matched_share, 0);
    EXPECT_GE(alignment.cost_m, 0.15);
  }
}

TEST(ScanAlignment, thins_scans_of_many_beams_and_sorts_mirrored_ones) {
  SimulatedRun run;
  run.truth = {{2.5, 2, 0.3}};
  run.bearings_rad = make_bearings_rad(BeamAngles::kCentredStepInclusive, 1081, DEG2RAD(270.0));
  EXPECT_LE(AlignableScan(run.scan(0), 30, 200).points().size(), 200U);
  for (float& bearing : run.bearings_rad) bearing = -bearing;
  const auto points = AlignableScan(run.scan(0)).points();
  for (std::size_t i = 1; i < points.size(); ++i) EXPECT_LT(points[i - 1].bearing_rad, points[i].bearing_rad);
}

TEST(ScanAlignment, sees_walls_across_the_ends_of_a_full_circle) {
  // A wall behind the laser: two points on one side of the seam and one on the other.
  LaserScan scan;
  const auto bearings = make_bearings_rad(BeamAngles::kLeftOpen, 360, 2 * M_PI);
  scan.bearings_rad = std::make_shared<const std::vector<float>>(bearings);
  scan.ranges_m.assign(360, std::numeric_limits<float>::quiet_NaN());
  for (const std::size_t beam : {0U, 1U, 359U})
    scan.ranges_m[beam] = static_cast<float>(-2 / std::cos(static_cast<double>(bearings[beam])));
  const AlignableScan circle(scan, 30, 400);
  EXPECT_TRUE(circle.is_full_circle());
  ASSERT_EQ(circle.points().size(), 3U);
  for (const auto& point : circle.points()) EXPECT_NEAR(std::abs(point.normal.x()), 1, 1e-6);
  SimulatedRun run;
  run.truth = {{2.5, 2, 0.3}};
  EXPECT_FALSE(AlignableScan(run.scan(0)).is_full_circle());
}

TEST(ScanAlignment, knows_the_blind_sector_of_a_laser_that_sees_straight_backwards) {
  SimulatedRun run;
  run.truth = {{6, 2, 0.3}, {6, 2, 0.3 + DEG2RAD(60.0)}};
  run.bearings_rad.clear();
  for (int i = 0; i <= 270; ++i)  // blind from -90 to 0 degrees
    run.bearings_rad.push_back(static_cast<float>(DEG2RAD(static_cast<double>(i))));
  const AlignableScan reference(run.scan(0));
  EXPECT_FALSE(reference.is_full_circle());
  EXPECT_NEAR(reference.bearing_rad({-1, -0.1}), M_PI + std::atan(0.1), 1e-9);
  const ScanAlignment alignment =
      align_scans(reference, AlignableScan(run.scan(1)), TPose2D{0, 0, DEG2RAD(58.0)});
  EXPECT_NEAR(alignment.reference_T_scan.phi, DEG2RAD(60.0), DEG2RAD(0.2));
  EXPECT_GT(alignment.matched_share, 0.95) << "points in the blind sector of the reference do not count";
}

TEST(ScanAlignment, of_full_circles_matches_points_across_their_ends) {
  SimulatedRun run;
  run.bearings_rad = make_bearings_rad(BeamAngles::kLeftOpen, 360, 2 * M_PI);
  const TPose2D motion{0, 0, DEG2RAD(4.0)};
  run.truth = {{2.5, 2, 0.3}, TPose2D{2.5, 2, 0.3} + motion};
  // Walls just beside the seam only.
  const auto behind = [&](std::size_t i, std::size_t beams_on_each_side) {
    LaserScan scan = run.scan(i);
    for (std::size_t beam = beams_on_each_side; beam < 360 - beams_on_each_side; ++beam)
      scan.ranges_m[beam] = std::numeric_limits<float>::quiet_NaN();
    return AlignableScan(scan, 30, 400);
  };
  const ScanAlignment alignment = align_scans(behind(0, 30), behind(1, 20), motion);
  EXPECT_GT(alignment.matched_share, 0.95);
  EXPECT_LT(alignment.cost_m, 0.03);
}

}  // namespace
}  // namespace psi_slam
