// SPDX-License-Identifier: BSD-3-Clause
#include "localization/localization_report.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace psi_slam {
namespace {

using State = LocalizationStep::State;
using testing::HasSubstr;

LocalizationStep step_at(double time_s, State state, double confidence) {
  LocalizationStep step;
  step.time_us = static_cast<TimeUs>(time_s * 1e6);
  step.state = state;
  step.map_T_robot = {time_s, 2, 0};
  step.fits = state == State::kTracking && confidence > 0;
  step.confidence = step.response = confidence;
  step.moved_m = 0.5;
  return step;
}

/// One scan per second. The robot is lost for 4 s, tracked for 16 s, and in the given state for 20 s.
std::vector<LocalizationStep> run_that_ends(State state, double confidence) {
  std::vector<LocalizationStep> steps;
  for (int i = 0; i < 4; ++i) steps.push_back(step_at(i, State::kLost, 0));
  for (int i = 4; i < 20; ++i) steps.push_back(step_at(i, State::kTracking, 0.9));
  for (int i = 20; i < 40; ++i) steps.push_back(step_at(i, state, confidence));
  return steps;
}

TEST(LocalizationReport, reports_when_and_where_the_robot_was_found) {
  const auto steps = run_that_ends(State::kTracking, 0.8);
  const LocalizationSummary summary = summarize(steps);
  EXPECT_TRUE(summary.found());
  EXPECT_EQ(*summary.found_after_s, 4);
  EXPECT_EQ(*summary.found_after_m, 2.5);
  EXPECT_EQ(summary.map_T_found.x, 4);
  EXPECT_TRUE(summary.localized_at_end());
  EXPECT_NEAR(summary.confidence, 0.8, 1e-12);
  EXPECT_NEAR(summary.tracked_share(), 0.9, 1e-12);
  EXPECT_FALSE(summary.lost_after_s);
  EXPECT_THAT(localization_text(summary),
              HasSubstr("Found after 2.5 m and 4.0 s at x 4.00 m, y 2.00 m, yaw 0.0 degrees"));
  EXPECT_THAT(localization_text(summary), HasSubstr("Localized at the end, with a confidence of 0.80.\n"));
  const auto json = nlohmann::json::parse(localization_json(summary));
  EXPECT_EQ(json["found_at"], nlohmann::json({4.0, 2.0, 0.0}));
  EXPECT_EQ(json["tracked_share"], 0.9);
}

TEST(LocalizationReport, a_robot_found_once_may_be_lost_at_the_end) {
  const LocalizationSummary lost = summarize(run_that_ends(State::kLost, 0));
  EXPECT_TRUE(lost.found());
  EXPECT_FALSE(lost.localized_at_end());
  EXPECT_EQ(lost.confidence, 0);
  EXPECT_EQ(lost.lost_after_s, 19.0);
  EXPECT_THAT(localization_text(lost), HasSubstr("Lost at the end, since 19.0 s: "));

  const LocalizationSummary unsure = summarize(run_that_ends(State::kTracking, 0.4));
  EXPECT_TRUE(unsure.tracked_at_end);
  EXPECT_FALSE(unsure.localized_at_end());
  EXPECT_THAT(
      localization_text(unsure),
      HasSubstr("Not localized at the end: tracked, but with a confidence of only 0.40, less than 0.50"));

  // In the last three of the five seconds at the end, poses are only predictions.
  auto steps = run_that_ends(State::kTracking, 0.9);
  for (auto step = steps.end() - 3; step != steps.end(); ++step) {
    step->fits = false;
    step->confidence = 0;
  }
  EXPECT_NEAR(summarize(steps).confidence, 0.45, 1e-12);
  EXPECT_FALSE(summarize(steps).localized_at_end());
}

TEST(LocalizationReport, ambiguity_is_that_of_the_last_search) {
  auto steps = run_that_ends(State::kLost, 0);
  FoundPlace rival;
  rival.response = 0.4;
  rival.ambiguous = true;
  rival.objection = "another place fits as well";
  steps.back().search = rival;
  EXPECT_TRUE(summarize(steps).found());
  EXPECT_TRUE(summarize(steps).ambiguous) << "the robot was lost, and two places fitted";
  EXPECT_EQ(summarize(steps).why_not, rival.objection);
  FoundPlace none = rival;
  none.ambiguous = false;
  none.response = 0.1;
  none.objection = "no place fits";
  steps.push_back(steps.back());
  steps.back().search = none;
  EXPECT_FALSE(summarize(steps).ambiguous);
  EXPECT_EQ(summarize(steps).best_response, 0.4);
}

TEST(LocalizationReport, the_end_has_at_least_five_scans) {
  std::vector<LocalizationStep> steps;
  for (int i = 0; i < 9; ++i) steps.push_back(step_at(100 * i, State::kTracking, i < 4 ? 0.1 : 0.7));
  EXPECT_NEAR(summarize(steps).confidence, 0.7, 1e-12);
  steps.resize(1);
  EXPECT_NEAR(summarize(steps).confidence, 0.1, 1e-12);
  EXPECT_FALSE(summarize({}).localized_at_end());
}

TEST(LocalizationReport, has_the_confidence_of_each_scan) {
  const std::string csv = localization_csv({step_at(1, State::kTracking, 0.75), step_at(2, State::kLost, 0)});
  EXPECT_EQ(csv,
            "time_s,state,x_m,y_m,theta_rad,response,confidence,fits,ambiguity,note\n"
            "1.000000,tracking,1.000000,2.000000,0.000000,0.7500,0.7500,1,,\n"
            "2.000000,lost,,,,0.0000,0.0000,0,,\n");
}

}  // namespace
}  // namespace psi_slam
