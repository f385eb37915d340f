// SPDX-License-Identifier: BSD-3-Clause
#include "localization/comparison/map_alignment.h"

#include <gmock/gmock.h>

#include "drawn_plan.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using testing::HasSubstr;

void expect_near(const TPose2D& pose, const TPose2D& expected, double tolerance_m) {
  EXPECT_NEAR(pose.x, expected.x, tolerance_m) << pose.asString();
  EXPECT_NEAR(pose.y, expected.y, tolerance_m) << pose.asString();
  EXPECT_NEAR(mrpt::math::wrapToPi(pose.phi - expected.phi), 0, 0.003) << pose.asString();
}

TEST(MapAlignment, finds_equal_frames_without_searching_the_whole_map) {
  const MapAlignment alignment = align_maps(map_of({}), map_of({}, {0.1, -0.2, 0.02}));
  EXPECT_EQ(alignment.method, MapAlignment::Method::kNearby);
  expect_near(alignment.a_T_b, {0.1, -0.2, 0.02}, 0.02);
  EXPECT_GT(alignment.agree, 0.95);
  EXPECT_FALSE(alignment.ambiguity);
}

TEST(MapAlignment, finds_maps_that_begin_anywhere_at_any_heading) {
  const DrawnPlan plan;
  const TPose2D plan_T_a(1, 2, 0.3);
  for (const TPose2D& plan_T_b : {TPose2D(8, 1, 2), TPose2D(-3, 6, -2.8), TPose2D(4, 4, 0.3 - M_PI)}) {
    const MapAlignment alignment = align_maps(map_of(plan, plan_T_a), map_of(plan, plan_T_b));
    EXPECT_EQ(alignment.method, MapAlignment::Method::kWholeMap);
    expect_near(alignment.a_T_b, plan_T_b - plan_T_a, 0.03);
    EXPECT_LT(alignment.ambiguity.value(), 0.9);
    EXPECT_GT(alignment.sigma_m(0), 0);
    EXPECT_LT(alignment.sigma_m(10), 0.1);
  }
}

TEST(MapAlignment, aligns_parts_of_a_building_in_both_directions) {
  DrawnPlan part;
  part.seen_from_x_m = 4;
  const TPose2D plan_T_b(6, 3, 1.5);
  const auto whole = map_of({});
  expect_near(align_maps(whole, map_of(part, plan_T_b)).a_T_b, plan_T_b, 0.03);
  const MapAlignment back = align_maps(map_of(part, plan_T_b), whole);
  expect_near(back.a_T_b, inverse(plan_T_b), 0.03);
  // The uncertainty is that of the walls in the middle of the part, in the frame of the first map.
  const auto centre = plan_T_b.composePoint(back.centre);
  EXPECT_NEAR(centre.x, 8, 1);
  EXPECT_NEAR(centre.y, 4, 1);
}

TEST(MapAlignment, a_corridor_is_uncertain_along_its_walls) {
  DrawnPlan corridor;
  corridor.walls = {{{0, 0}, {12, 0}}, {{0, 2}, {12, 2}}};
  corridor.height_m = 2;
  for (const double turn_rad : {0.0, M_PI / 2}) {
    const TPose2D plan_T_map(0, 0, turn_rad);
    MapAlignmentOptions options;
    options.a_T_b = TPose2D(0, 0, 0);
    const auto map = map_of(corridor, plan_T_map);
    const Eigen::Matrix3d covariance = align_maps(map, map, options).covariance;
    const int along = turn_rad == 0 ? 0 : 1;
    EXPECT_GT(covariance(along, along), 4 * covariance(1 - along, 1 - along)) << turn_rad;
  }
}

/// A square room, which fits in four directions.
DrawnPlan square_room() {
  DrawnPlan square;
  square.width_m = square.height_m = 6;
  square.walls = {{{0, 0}, {6, 0}}, {{6, 0}, {6, 6}}, {{6, 6}, {0, 6}}, {{0, 6}, {0, 0}}};
  return square;
}

TEST(MapAlignment, a_rough_pose_decides_between_alike_places) {
  const auto a = map_of(square_room());
  const auto b = map_of(square_room(), {2, 1, 0.5});
  EXPECT_THAT(sentence_of([&] { align_maps(a, b); }), HasSubstr("another alignment fits nearly as well"));
  MapAlignmentOptions options;
  options.a_T_b = TPose2D(2.5, 0.7, 0.4);
  expect_near(align_maps(a, b, options).a_T_b, {2, 1, 0.5}, 0.03);
}

TEST(MapAlignment, keeps_equal_frames_if_no_other_place_fits_better) {
  MapAlignmentOptions options;
  options.min_agree_in_same_frame = 2;  // the whole map is always searched
  const auto map = map_of({});
  EXPECT_EQ(align_maps(map, map, options).method, MapAlignment::Method::kNearby);
}

TEST(MapAlignment, refuses_maps_with_too_few_walls) {
  DrawnPlan bare;
  bare.walls = {{{3, 3}, {3.02, 3}}};
  const DrawnPlan plan;
  for (const auto& options : {MapAlignmentOptions(), MapAlignmentOptions{TPose2D(0, 0, 0)}}) {
    EXPECT_THAT(sentence_of([&] { align_maps(map_of(plan), map_of(bare), options); }),
                HasSubstr("has too few walls to be aligned, expected"));
    EXPECT_THAT(sentence_of([&] { align_maps(map_of(bare), map_of(plan), options); }),
                HasSubstr("the first map has too few walls, expected"));
  }
}

TEST(MapAlignment, refuses_maps_of_other_buildings) {
  DrawnPlan other;
  other.width_m = 7;
  other.height_m = 14;
  other.walls.clear();
  for (int i = 0; i < 6; ++i) other.walls.push_back({{0.5 + i, 0.3 * i}, {1.2 + 0.5 * i, 12.0 - 1.7 * i}});
  EXPECT_THAT(sentence_of([&] { align_maps(map_of({}), map_of(other)); }), HasSubstr("does not fit"));
  MapAlignmentOptions options;
  options.a_T_b = TPose2D(5, 5, 1);
  EXPECT_THAT(sentence_of([&] { align_maps(map_of({}), map_of({}), options); }),
              HasSubstr("Correct the pose of --start"));
}

}  // namespace
}  // namespace psi_slam
