// SPDX-License-Identifier: BSD-3-Clause
#include "localization/global_search.h"

#include <gtest/gtest.h>

namespace psi_slam {
namespace {

/// Score grid of 4 m x 4 m with a wall at x = 2 m.
ScoreGrid wall_across() {
  ScoreGrid grid(0, 0, 0.05, 80, 80);
  for (int y = 0; y < 80; ++y) *grid.finest().cell(40, y) = 255;
  return grid;
}

ScanPoints one_point(float x, float y) {
  ScanPoints scan;
  scan.points = {{x, y}};
  scan.farthest_m = 4;
  return scan;
}

TEST(ClearBeams, a_beam_through_a_wall_is_not_clear_and_one_that_ends_there_is) {
  const ScoreGrid map = wall_across();
  EXPECT_EQ(clear_beams(map, one_point(1, 0), {1, 2, 0}).clear, 1U) << "the beam ends at the wall";
  EXPECT_EQ(clear_beams(map, one_point(2.5F, 0), {1, 2, 0}).clear, 0U) << "the beam goes through the wall";
  EXPECT_EQ(clear_beams(map, one_point(2.5F, 0), {1, 2, M_PI}).clear, 1U)
      << "the beam points away from the wall";
  EXPECT_EQ(clear_beams(map, one_point(2.5F, 0), {1, 2, 0}).beams, 1U);
}

TEST(ClearBeams, beams_begin_at_the_laser) {
  ScanPoints scan = one_point(2.5F, 0);
  scan.origin = {1.5F, 0};
  EXPECT_EQ(clear_beams(wall_across(), scan, {1, 2, 0}).clear, 1U) << "the laser is beyond the wall";
}

TEST(ClearBeams, a_grazed_wall_counts_as_the_end_of_the_beam) {
  ScanPoints scan = one_point(0.1F, 1.5F);  // a beam almost along the wall
  scan.normals = {{1, 0}};
  EXPECT_EQ(clear_beams(wall_across(), scan, {1.95, 1, 0}).clear, 1U);
}

TEST(ClearBeams, specks_and_ends_of_walls_do_not_block_beams) {
  ScoreGrid map(0, 0, 0.05, 80, 80);
  *map.finest().cell(40, 40) = 255;
  EXPECT_EQ(clear_beams(map, one_point(2.5F, 0), {1, 2.02, 0}).clear, 1U) << "a speck";
  for (int y = 40; y < 80; ++y) *map.finest().cell(40, y) = 255;
  EXPECT_EQ(clear_beams(map, one_point(2.5F, 0), {1, 2.02, 0}).clear, 1U) << "the end of a wall";
  EXPECT_EQ(clear_beams(map, one_point(2.5F, 0), {1, 2.3, 0}).clear, 0U) << "the wall";
}

TEST(ClearBeams, a_slanted_wall_blocks_beams) {
  ScoreGrid map(0, 0, 0.05, 80, 80);
  for (int i = 0; i < 79; ++i) *map.finest().cell(i, i) = *map.finest().cell(i, i + 1) = 255;
  for (const double heading_rad : {0.0, -0.3, -M_PI / 4, -1.2})
    EXPECT_EQ(clear_beams(map, one_point(2.5F, 0), {1, 2, heading_rad}).clear, 0U) << heading_rad;
}

TEST(ClearBeams, without_beams_the_clear_share_is_zero) {
  EXPECT_EQ(clear_beams(wall_across(), {}, {1, 2, 0}).share(), 0);
}

TEST(ClearBeams, beams_begin_at_their_own_laser) {
  ScanPoints scan = one_point(2.5F, 0);  // seen from the robot, this beam goes through the wall
  scan.points.push_back(scan.points.front());
  scan.other_lasers.push_back({1, {1.5F, 0}});  // this laser is beyond the wall
  const ClearBeams beams = clear_beams(wall_across(), scan, {1, 2, 0});
  EXPECT_EQ(beams.beams, 2U);
  EXPECT_EQ(beams.clear, 1U);
}

}  // namespace
}  // namespace psi_slam
