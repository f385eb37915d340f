// SPDX-License-Identifier: BSD-3-Clause
#include "map/trajectory/relations_metric.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <cmath>
#include <fstream>
#include <limits>
#include <numeric>
#include <random>

#include "psi_slam/user_error.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double kTolerance = 1e-9;

TEST(RelationsMetric, a_perfect_trajectory_has_no_error) {
  const Trajectory trajectory = {{0, {5, 5, 1}}, {1'000'000, TPose2D(5, 5, 1) + TPose2D(2, 1, -0.5)}};
  const RelationsMetric metric = evaluate_relations(trajectory, {{0, 1'000'000, {2, 1, -0.5}}});
  EXPECT_EQ(metric.exact, 1u);
  EXPECT_NEAR(metric.translation_abs_m.mean, 0, kTolerance);
  EXPECT_NEAR(metric.rotation_abs_deg.max, 0, kTolerance);
  EXPECT_NEAR(metric.cartographer_translation_abs_m.mean, 0, kTolerance);
}

TEST(RelationsMetric, a_wrong_heading_counts_in_cartographers_lengths_only) {
  // The trajectory goes 10 m ahead correctly, but its heading is wrong by a right angle.
  const RelationsMetric metric =
      evaluate_relations({{0, {0, 0, 0}}, {1'000'000, {10, 0, M_PI_2}}}, {{0, 1'000'000, {10, 0, 0}}});
  EXPECT_NEAR(metric.translation_abs_m.mean, 0, kTolerance);
  EXPECT_NEAR(metric.rotation_abs_deg.mean, 90, kTolerance);
  EXPECT_NEAR(metric.rotation_sq_deg2.mean, 8100, 1e-6);
  EXPECT_NEAR(metric.cartographer_translation_abs_m.mean, std::hypot(10, 10), kTolerance);
}

TEST(RelationsMetric, accepts_relations_in_either_order_of_time) {
  const RelationsMetric metric =
      evaluate_relations({{0, {0, 0, 0}}, {1'000'000, {3, 0, M_PI_2}}}, {{1'000'000, 0, {0, 3, -M_PI_2}}});
  EXPECT_NEAR(metric.translation_abs_m.mean, 0, kTolerance);
  EXPECT_NEAR(metric.rotation_abs_deg.mean, 0, kTolerance);
}

TEST(RelationsMetric, summarises_the_population) {
  const ErrorSummary summary = summarize({4, 1, 2, 3});
  EXPECT_DOUBLE_EQ(summary.mean, 2.5);
  EXPECT_DOUBLE_EQ(summary.std, std::sqrt(1.25));
  EXPECT_EQ(summary.median, 3);
  EXPECT_EQ(summary.p95, 4);
  EXPECT_EQ(summary.max, 4);
  std::vector<double> hundred(100);
  std::iota(hundred.begin(), hundred.end(), 0);
  EXPECT_EQ(summarize(hundred).p95, 95);
  EXPECT_THROW(summarize({}), std::invalid_argument);
}

TEST(RelationsMetric, interpolates_by_time_and_along_the_shorter_arc) {
  // From 170 to -170 degrees the robot turns by 20 degrees, not by -340. After a quarter of the turn its
  // heading is 175 degrees.
  const double degree = M_PI / 180;
  const Trajectory trajectory = {
      {0, {0, 0, 0}}, {1'000'000, {0, 0, 170 * degree}}, {2'000'000, {4, 8, -170 * degree}}};
  const RelationsMetric metric = evaluate_relations(trajectory, {{0, 1'250'000, {1, 2, 175 * degree}}});
  EXPECT_EQ(metric.interpolated, 1u);
  EXPECT_TRUE(metric.errors.at(0).interpolated);
  EXPECT_NEAR(metric.translation_abs_m.mean, 0, kTolerance);
  EXPECT_NEAR(metric.rotation_abs_deg.mean, 0, 1e-6);
}

TEST(RelationsMetric, angles_of_errors_wrap_around) {
  const double degree = M_PI / 180;
  const RelationsMetric metric = evaluate_relations({{0, {0, 0, 0}}, {1'000'000, {0, 0, 179 * degree}}},
                                                    {{0, 1'000'000, {0, 0, -179 * degree}}});
  EXPECT_NEAR(metric.rotation_abs_deg.mean, 2, 1e-6);
}

TEST(RelationsMetric, a_pose_within_a_tenth_of_a_millisecond_is_exact) {
  const Trajectory trajectory = {{0, {0, 0, 0}}, {1'000'000, {1, 0, 0}}, {2'000'000, {2, 0, 0}}};
  for (const TimeUs offset : {-99, 99}) {
    const RelationsMetric metric = evaluate_relations(trajectory, {{0, 1'000'000 + offset, {1, 0, 0}}});
    EXPECT_EQ(metric.exact, 1u);
    EXPECT_EQ(metric.translation_abs_m.mean, 0);
  }
  const RelationsMetric metric = evaluate_relations(trajectory, {{0, 1'000'100, {1, 0, 0}}});
  EXPECT_EQ(metric.interpolated, 1u);
  EXPECT_NEAR(metric.translation_abs_m.mean, 1e-4, 1e-12);
}

TEST(RelationsMetric, skips_and_counts_relations_outside_or_in_a_long_gap) {
  const Trajectory trajectory = {{0, {}}, {1'000'000, {}}, {4'000'000, {}}};
  const std::vector<Relation> relations = {{0, 1'000'000, {}},           // used
                                           {-1'000'000, 1'000'000, {}},  // starts before the trajectory
                                           {0, 4'000'101, {}},           // ends after the trajectory
                                           {0, 2'000'000, {}}};          // in a gap of 3 s
  EXPECT_EQ(evaluate_relations(trajectory, relations).skipped, 3u);
  EXPECT_EQ(evaluate_relations(trajectory, relations).exact, 1u);
  const RelationsMetric wider = evaluate_relations(trajectory, relations, {3.0});
  EXPECT_EQ(wider.skipped, 2u);
  EXPECT_EQ(wider.interpolated, 1u);
  EXPECT_EQ(evaluate_relations(trajectory, relations, {std::numeric_limits<double>::infinity()}).skipped, 2u);
  EXPECT_THROW(evaluate_relations(trajectory, relations, {-1}), std::invalid_argument);
}

TEST(RelationsMetric, sorts_by_time_and_keeps_the_order_of_equal_times) {
  const Trajectory trajectory = {
      {2'000'000, {2, 0, 0}}, {0, {0, 0, 0}}, {1'000'000, {1, 0, 0}}, {1'000'000, {7, 0, 0}}};
  const RelationsMetric metric =
      evaluate_relations(trajectory, {{0, 1'000'000, {1, 0, 0}}, {0, 1'500'000, {4.5, 0, 0}}});
  EXPECT_NEAR(metric.errors[0].translation_m, 0, kTolerance) << "uses the first of two poses of equal time";
  EXPECT_NEAR(metric.errors[1].translation_m, 0, kTolerance)
      << "interpolates from the last of two poses of equal time";
}

TEST(RelationsMetric, names_both_spans_of_time_if_nothing_matches) {
  try {
    evaluate_relations({{10'000'000, {}}, {20'000'000, {}}}, {{976052905167303, 976052896784509, {}}});
    FAIL() << "no exception";
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("from 10.000000 s to 20.000000 s"),
                                    HasSubstr("from 976052896.784509 s to 976052905.167303 s")));
  }
}

TEST(RelationsMetric, reads_relations_and_names_file_and_line_of_errors) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "log.relations";
  std::ofstream(path) << "# true relations\n976052905.167303 976052911.885496 -0.05 -0.13 0 0 0 -1.68221\n";
  const auto relations = read_relations(path);
  ASSERT_EQ(relations.size(), 1u);
  EXPECT_EQ(relations[0].time2_us, 976052911885496);
  EXPECT_EQ(relations[0].pose1_T_pose2, TPose2D(-0.05, -0.13, -1.68221));
  const auto complaint = [&](const std::string& text) -> std::string {
    std::ofstream(path) << text;
    try {
      read_relations(path);
    } catch (const UserError& error) {
      return error.what();
    }
    return "no complaint";
  };
  EXPECT_THAT(complaint("\n1 2 3\n"),
              HasSubstr("log.relations:2: expected 'time1 time2 x y z roll pitch yaw'"));
  EXPECT_THAT(complaint("1 2 3 4 5 6 7 east\n"), HasSubstr("yaw in radians"));
  EXPECT_THAT(complaint("#\n"), HasSubstr("no relation found"));
}

// Errors of a relation, computed independently with homogeneous matrices and linear searches.
struct SlowErrors {
  double translation_m;
  double rotation_deg;
  double cartographer_translation_m;
};

Eigen::Matrix3d matrix(const TPose2D& pose) {
  Eigen::Matrix3d result = Eigen::Matrix3d::Identity();
  result.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(pose.phi).toRotationMatrix();
  result(0, 2) = pose.x;
  result(1, 2) = pose.y;
  return result;
}

Eigen::Matrix3d slow_pose_at(const Trajectory& trajectory, TimeUs time_us) {
  const StampedPose* before = nullptr;
  const StampedPose* after = nullptr;
  for (const StampedPose& pose : trajectory) {
    if (std::abs(pose.time_us - time_us) < 100) return matrix(pose.pose);
    if (pose.time_us < time_us && (!before || pose.time_us >= before->time_us)) before = &pose;
    if (pose.time_us > time_us && (!after || pose.time_us < after->time_us)) after = &pose;
  }
  const double u =
      static_cast<double>(time_us - before->time_us) / static_cast<double>(after->time_us - before->time_us);
  Eigen::Matrix3d result = Eigen::Matrix3d::Identity();
  const Eigen::Rotation2Dd turn =
      Eigen::Rotation2Dd(before->pose.phi).slerp(u, Eigen::Rotation2Dd(after->pose.phi));
  result.topLeftCorner<2, 2>() = turn.toRotationMatrix();
  result(0, 2) = before->pose.x * (1 - u) + after->pose.x * u;
  result(1, 2) = before->pose.y * (1 - u) + after->pose.y * u;
  return result;
}

SlowErrors slow_errors(const Trajectory& trajectory, const Relation& relation) {
  const Eigen::Matrix3d estimate =
      slow_pose_at(trajectory, relation.time1_us).inverse() * slow_pose_at(trajectory, relation.time2_us);
  const Eigen::Matrix3d error = matrix(relation.pose1_T_pose2).inverse() * estimate;
  const Eigen::Matrix3d other = estimate * matrix(relation.pose1_T_pose2).inverse();
  return {error.topRightCorner<2, 1>().norm(), std::abs(std::atan2(error(1, 0), error(0, 0))) * 180 / M_PI,
          other.topRightCorner<2, 1>().norm()};
}

TEST(RelationsMetric, agrees_with_a_slow_independent_computation) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> metres(-30, 30);
  std::uniform_real_distribution<double> angle(-M_PI, M_PI);
  std::uniform_int_distribution<TimeUs> within(0, 199'000'000);
  Trajectory trajectory;
  for (int i = 0; i < 200; ++i)
    trajectory.push_back({i * 1'000'000, {metres(random), metres(random), angle(random)}});
  std::vector<Relation> relations;
  for (int i = 0; i < 300; ++i) {
    const bool exact = i % 3 == 0;
    const TimeUs time1 = within(random);
    const TimeUs time2 = within(random);
    relations.push_back({exact ? time1 / 1'000'000 * 1'000'000 : time1,
                         exact ? time2 / 1'000'000 * 1'000'000 : time2,
                         {metres(random), metres(random), angle(random)}});
  }
  Trajectory shuffled = trajectory;
  std::shuffle(shuffled.begin(), shuffled.end(), random);
  const RelationsMetric metric = evaluate_relations(shuffled, relations);
  ASSERT_EQ(metric.errors.size(), relations.size());
  double sum = 0;
  double squares = 0;
  for (std::size_t i = 0; i < relations.size(); ++i) {
    const SlowErrors slow = slow_errors(trajectory, relations[i]);
    EXPECT_NEAR(metric.errors[i].translation_m, slow.translation_m, 1e-6);
    EXPECT_NEAR(metric.errors[i].rotation_deg, slow.rotation_deg, 1e-6);
    EXPECT_NEAR(metric.errors[i].cartographer_translation_m, slow.cartographer_translation_m, 1e-6);
    sum += slow.translation_m;
    squares += slow.translation_m * slow.translation_m;
  }
  EXPECT_NEAR(metric.translation_abs_m.mean, sum / 300, 1e-6);
  EXPECT_NEAR(metric.translation_sq_m2.mean, squares / 300, 1e-6);
}

}  // namespace
}  // namespace psi_slam
