// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <algorithm>

#include "logs/doctor/input_doctor.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// Measurements of a log in which nothing is wrong.
LogDiagnosis sound_log() {
  LogDiagnosis diagnosis;
  diagnosis.facts.format = "CARMEN";
  diagnosis.facts.scans = 100;
  diagnosis.facts.odometry.path_length_m = 20;
  diagnosis.facts.odometry.turned_rad = 6;
  diagnosis.facts.ranges.readings = 18'000;
  diagnosis.facts.ranges.returns = 17'000;
  diagnosis.facts.ranges.max_range_m = 30;
  diagnosis.odometry.length_samples = 30;
  diagnosis.odometry.length_ratio = 1;
  diagnosis.odometry.length_share = 1;
  diagnosis.odometry.heading = HeadingRelation::kAgrees;
  diagnosis.odometry_is_sound = true;
  return diagnosis;
}

Finding finding_of(const LogDiagnosis& diagnosis, const std::string& code) {
  const std::vector<Finding> findings = judge(diagnosis);
  const auto found = std::find_if(findings.begin(), findings.end(),
                                  [&](const Finding& finding) { return finding.code == code; });
  return found == findings.end() ? Finding() : *found;
}

TEST(LogFindings, are_none_for_a_sound_log) {
  EXPECT_THAT(judge(sound_log()), IsEmpty());
}

TEST(LogFindings, readings_of_zero_do_not_question_the_maximum_range) {
  LogDiagnosis diagnosis = sound_log();
  diagnosis.facts.ranges.returns = 3'168;
  EXPECT_THAT(finding_of(diagnosis, "few_returns").remedy, HasSubstr("log.max_range_m"));
  diagnosis.facts.ranges.invalid = 14'000;
  const Finding finding = finding_of(diagnosis, "few_returns");
  EXPECT_EQ(finding.severity, Severity::kNote);
  EXPECT_THAT(finding.sentence, HasSubstr("only 17.6 % of the readings are returns, and 77.8 % are zero"));
  EXPECT_EQ(finding.remedy, "");
}

TEST(LogFindings, rounded_stamps_do_not_run_backwards) {
  LogDiagnosis diagnosis = sound_log();
  diagnosis.facts.time.backward_steps = 3;
  diagnosis.facts.time.largest_backward_step_s = 0.0002;
  EXPECT_THAT(judge(diagnosis), IsEmpty());
  diagnosis.facts.time.largest_backward_step_s = 0.02;
  EXPECT_THAT(finding_of(diagnosis, "time_backwards").sentence, HasSubstr("by up to 0.020 s"));
}

TEST(LogFindings, a_second_pose_that_moves_with_the_robot_is_not_the_result_of_a_mapper) {
  LogDiagnosis diagnosis = sound_log();
  diagnosis.facts.contents.scans_with_two_poses = 100;
  EXPECT_THAT(judge(diagnosis), IsEmpty());
  diagnosis.facts.contents.second_pose_is_mapped = true;
  EXPECT_THAT(finding_of(diagnosis, "two_poses").sentence, HasSubstr("the result of a mapper"));
}

TEST(LogFindings, headings_of_bags_are_never_degrees) {
  LogDiagnosis diagnosis = sound_log();
  diagnosis.odometry_is_sound = false;
  diagnosis.odometry.heading = HeadingRelation::kDegrees;
  EXPECT_THAT(finding_of(diagnosis, "odometry_degrees").sentence, HasSubstr("degrees"));
  diagnosis.headings_are_quaternions = true;
  EXPECT_EQ(finding_of(diagnosis, "odometry_degrees").sentence, "");
  EXPECT_THAT(finding_of(diagnosis, "odometry_unrelated").sentence, HasSubstr("unrelated"));
}

TEST(LogFindings, a_unit_of_length_needs_a_common_ratio) {
  LogDiagnosis diagnosis = sound_log();
  diagnosis.odometry_is_sound = false;
  diagnosis.odometry.length_ratio = 3.2;
  EXPECT_THAT(finding_of(diagnosis, "odometry_unit").sentence, HasSubstr("feet"));
  diagnosis.odometry.length_share = 0.3;
  EXPECT_THAT(finding_of(diagnosis, "odometry_unit").sentence, testing::Not(HasSubstr("feet")));
  diagnosis.odometry.heading = HeadingRelation::kUnrelated;
  EXPECT_EQ(finding_of(diagnosis, "odometry_unit").sentence, "");
  diagnosis.odometry.heading = HeadingRelation::kDegrees;
  diagnosis.headings_are_quaternions = true;
  EXPECT_EQ(finding_of(diagnosis, "odometry_unit").sentence, "");
}

TEST(LogFindings, a_turned_laser_is_told_without_an_estimate_of_its_mount) {
  LogDiagnosis diagnosis = sound_log();
  diagnosis.laser_is_turned = true;
  diagnosis.odometry.direction_offset_rad = M_PI;
  diagnosis.odometry.direction_concentration = 1;
  const Finding finding = finding_of(diagnosis, "laser_heading");
  EXPECT_THAT(finding.sentence, HasSubstr("the stated heading of the laser is wrong"));
  EXPECT_THAT(finding.sentence, testing::Not(HasSubstr("across its headings")));
  diagnosis.odometry.odometry_slip_rad = 0.7;
  EXPECT_THAT(finding_of(diagnosis, "laser_heading").sentence, HasSubstr("across its headings"));
}

TEST(LogFindings, an_offset_of_clocks_replaces_other_findings_about_odometry) {
  LogDiagnosis diagnosis = sound_log();
  diagnosis.odometry_is_sound = false;
  diagnosis.odometry.length_ratio = 3.2;
  diagnosis.odometry.heading = HeadingRelation::kNone;
  diagnosis.odometry.clock_offset = ScanDelay{100, -2.0, 0.001};
  const std::vector<Finding> findings = judge(diagnosis);
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_THAT(findings.front().sentence, HasSubstr("differ by 2.000 s (standard deviation 0.001 s)"));
  EXPECT_EQ(findings.front().remedy, "log.scan_delay_s = -2.000");
}

}  // namespace
}  // namespace psi_slam
