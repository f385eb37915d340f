// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/fixed_knowledge.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "local_maps/simulated_drive.h"
#include "logs/frames/pose_operations.h"
#include "mapping/mapper_options.h"
#include "psi_slam/mapper.h"
#include "same_map.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr double kDegree = M_PI / 180;

// The frame of the site: the robot starts at this pose.
const TPose2D kSite_T_start(40, -7, 100 * kDegree);

// A run along a corridor of 70 m without features. The laser reaches 30 m and sees ahead only, so most of the
// way its length is known by odometry alone, which is 4 % short.
const SimulatedDrive& corridor_drive() {
  static const SimulatedDrive drive = [] {
    SimulatedWalls corridor;
    corridor.add_box(0, 0, 70, 2.4);
    OdometryErrors errors;
    errors.length_factor = 0.96;
    errors.length_share = 0.05;
    return drive_along(corridor, path_along({{2, 1.2}, {66, 1.2}}, 0.2), errors, 5);
  }();
  return drive;
}

TPose2D site_T_robot(std::size_t frame) {
  return kSite_T_start + corridor_drive().map_T_robot[frame];
}

KnownPose known_pose(std::size_t frame) {
  KnownPose pose;
  pose.time_us = corridor_drive().frames[frame].time_us;
  pose.site_T_robot = {site_T_robot(frame), 0.02, 1 * kDegree};
  pose.source = "my.edits:" + std::to_string(frame);
  return pose;
}

TagSighting sighting(const std::string& name, const TPose2D& site_T_tag, std::size_t frame) {
  TagSighting seen;
  seen.name = name;
  seen.time_us = corridor_drive().frames[frame].time_us;
  seen.robot_T_tag = {site_T_tag - site_T_robot(frame), 0.03, {}};
  seen.robot_T_tag.pose.phi = 0;
  seen.source = "seen:" + std::to_string(frame);
  return seen;
}

FixedKnowledge known_poses() {
  FixedKnowledge knowledge;
  for (const std::size_t frame : {0U, 80U, 160U, 240U, 320U}) knowledge.poses.push_back(known_pose(frame));
  return knowledge;
}

MapperOptions options() {
  MapperOptions options;
  options.back_end.final_search.passes = 1;
  return options;
}

MappingResult map_with(const FixedKnowledge& knowledge, const MapperOptions& options = options()) {
  Mapper mapper(options);
  mapper.set_knowledge(knowledge);
  for (const Frame& frame : corridor_drive().frames) mapper.add(frame);
  return mapper.finish();
}

// Mean distance of the scans from their true places, if the true pose of the first scan is `map_T_start`.
double mean_error_m(const MappingResult& result, const TPose2D& map_T_start) {
  double sum = 0;
  for (std::size_t i = 0; i < result.frames.size(); ++i) {
    const TPose2D truth = map_T_start + corridor_drive().map_T_robot[i];
    sum += std::hypot(result.frames[i].map_T_robot.x - truth.x, result.frames[i].map_T_robot.y - truth.y);
  }
  return sum / static_cast<double>(result.frames.size());
}

const MappingResult& map_with_poses() {
  static const MappingResult result = map_with(known_poses());
  return result;
}

TEST(FixedKnowledge, known_poses_correct_the_drift_and_state_the_frame) {
  EXPECT_GT(mean_error_m(map_with({}), {0, 0, 0}), 0.5);
  EXPECT_LT(mean_error_m(map_with_poses(), kSite_T_start), 0.2);
  EXPECT_THAT(map_with_poses().contradictions, Each(HasSubstr("in the finished map"))) << "none is left out";
  EXPECT_EQ(map_with_poses().knowledge.used, 5U);
  EXPECT_EQ(map_with_poses().knowledge.left_out, 0U);
}

TEST(FixedKnowledge, positions_without_headings_do_too) {
  FixedKnowledge knowledge = known_poses();
  for (KnownPose& pose : knowledge.poses) pose.site_T_robot.sigma_rad.reset();
  const MappingResult result = map_with(knowledge);
  EXPECT_LT(mean_error_m(result, kSite_T_start), 0.2);
  EXPECT_THAT(result.contradictions, Each(HasSubstr("in the finished map"))) << "none is left out";
}

TEST(FixedKnowledge, a_wrong_pose_is_named_and_left_out) {
  FixedKnowledge knowledge = known_poses();
  KnownPose wrong = known_pose(200);
  wrong.site_T_robot.pose = wrong.site_T_robot.pose + TPose2D(5, 0, 0);
  knowledge.poses.push_back(wrong);
  const MappingResult result = map_with(knowledge);
  EXPECT_THAT(result.contradictions,
              Contains(AllOf(HasSubstr("my.edits:200: the pose at 1020.000000 s is left out"),
                             HasSubstr("off by 5."))));
  EXPECT_EQ(result.knowledge.used, 5U);
  EXPECT_EQ(result.knowledge.left_out, 1U);
  EXPECT_LT(mean_error_m(result, kSite_T_start), mean_error_m(map_with_poses(), kSite_T_start) + 0.02);
}

TEST(FixedKnowledge, the_order_and_the_threads_do_not_change_a_bit) {
  FixedKnowledge knowledge = known_poses();
  std::reverse(knowledge.poses.begin(), knowledge.poses.end());
  MapperOptions two_threads = options();
  two_threads.back_end.threads = 2;
  expect_same_map(map_with(knowledge, two_threads), map_with_poses());
}

TEST(FixedKnowledge, needs_no_loop_closing) {
  MapperOptions without_loops = options();
  without_loops.close_loops = false;
  EXPECT_LT(mean_error_m(map_with(known_poses(), without_loops), kSite_T_start), 0.2);
}

TEST(FixedKnowledge, what_cannot_be_used_gets_a_sentence) {
  FixedKnowledge knowledge;
  knowledge.poses.push_back(known_pose(10));
  knowledge.poses.back().time_us = 5'000'000;
  knowledge.tags.push_back({"A", {{1, 2, 0}, 0.1, {}}, "my.edits:3"});
  knowledge.sightings.push_back(sighting("B", {1, 2, 0}, 20));
  const MappingResult result = map_with(knowledge);
  EXPECT_THAT(result.contradictions,
              ElementsAre(AllOf(HasSubstr("my.edits:10: the log has no scan at 5.000000 s"),
                                HasSubstr("from 1000.000000 s to")),
                          HasSubstr("my.edits:3: tag A was never seen"),
                          HasSubstr("seen:20: tag B was seen only once")));
  EXPECT_EQ(result.knowledge.used, 0U);
  EXPECT_EQ(result.knowledge.left_out, 3U);
  EXPECT_EQ(result.graph.root(), 0U);
  EXPECT_EQ(result.graph.pose(0), TPose2D(0, 0, 0));
}

TEST(FixedKnowledge, a_time_without_scan_is_named_after_a_run_without_scans) {
  FixedKnowledge knowledge;
  knowledge.poses.push_back(known_pose(10));
  knowledge.poses.back().time_us = 5'000'000;
  Mapper mapper(options());
  for (std::size_t i = 0; i < 20; ++i) mapper.add(corridor_drive().frames[i]);
  mapper.begin_run({});
  mapper.set_knowledge(knowledge);
  EXPECT_THAT(mapper.finish().contradictions,
              ElementsAre(AllOf(HasSubstr("the log has no scan at 5.000000 s"), Not(HasSubstr(" or ")))));
}

TEST(FixedKnowledge, a_reopened_map_can_be_finished_with_other_knowledge) {
  Mapper mapper(options());
  for (const Frame& frame : corridor_drive().frames) mapper.add(frame);
  MappingResult first = mapper.finish({}, Mapper::AfterFinish::kReopen);
  mapper.reopen(std::move(first));
  mapper.set_knowledge(known_poses());
  expect_same_map(mapper.finish(), map_with_poses());
}

}  // namespace
}  // namespace psi_slam
