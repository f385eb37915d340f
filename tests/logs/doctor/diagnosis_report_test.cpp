// SPDX-License-Identifier: BSD-3-Clause
#include "logs/doctor/input_doctor.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "log_files.h"
#include "simulated_run.h"
#include "swinging_robot.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::StartsWith;

class DiagnosisReportTest : public testing::Test {
 protected:
  LogDiagnosis mirrored_log() {
    SimulatedRun run = round_trips(1);
    for (float& bearing : run.bearings_rad) bearing = -bearing;
    write_file(folder_.path() / "log.clf", carmen_log(run));
    return diagnose(folder_.path() / "log.clf");
  }

  LogDiagnosis sound_log() {
    write_file(folder_.path() / "log.clf", carmen_log(round_trips(1)));
    return diagnose(folder_.path() / "log.clf");
  }

  TemporaryFolder folder_;
};

TEST_F(DiagnosisReportTest, describes_the_log) {
  const auto lines = describe_facts(sound_log());
  EXPECT_THAT(lines,
              Contains("log.clf: CARMEN, 537 scans by FLASER of 180 beams from -90.00 to 89.00 degrees"));
  EXPECT_THAT(lines, Contains("time: 107.2 s from 1000.000000, a scan every 0.200 s"));
  EXPECT_THAT(lines, Contains(StartsWith("odometry: ")));
  EXPECT_THAT(lines, Contains(StartsWith("ranges: maximum 50.00 m, median ")));
}

TEST_F(DiagnosisReportTest, prints_the_remedy_of_each_warning) {
  const auto lines = describe(mirrored_log());
  const auto warning =
      std::find(lines.begin(), lines.end(),
                "warning: the scans turn right where odometry turns left: the scan is mirrored");
  ASSERT_NE(warning, lines.end());
  EXPECT_EQ(*(warning + 1), "  remedy: log.mirrored = true");
}

TEST_F(DiagnosisReportTest, ends_with_a_verdict) {
  EXPECT_EQ(describe(sound_log()).back(), "verdict: ready to map");
  EXPECT_EQ(describe(mirrored_log()).back(), "verdict: maps with 1 warning");
}

TEST_F(DiagnosisReportTest, marks_the_best_beam_angles) {
  const auto lines = describe_beam_angles(sound_log().beam_angles);
  ASSERT_EQ(lines.size(), 5U);
  EXPECT_THAT(lines[0], StartsWith("beam angles, by "));
  EXPECT_THAT(lines, Contains(StartsWith("  * left_open  ")));
  EXPECT_THAT(lines, Contains(testing::AllOf(StartsWith("    skip_zero"), HasSubstr("ruled out"))));
  EXPECT_TRUE(describe_beam_angles(mirrored_log().beam_angles).empty());
}

TEST_F(DiagnosisReportTest, marks_the_best_sweep_direction) {
  write_mcap(folder_.path() / "run.mcap", swinging_robot({SwingingLaser{"/scan", true}}));
  const LogDiagnosis diagnosis = diagnose(folder_.path() / "run.mcap");
  const auto lines = describe_sweep_direction(diagnosis.sweep_direction);
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_THAT(lines[0], StartsWith("order of the beams in a sweep of 0.150 s, by "));
  EXPECT_THAT(lines[1], testing::AllOf(StartsWith("    forward "), HasSubstr("ruled out")));
  EXPECT_THAT(lines[2], testing::AllOf(StartsWith("  * backward "), testing::Not(HasSubstr("ruled out"))));
  EXPECT_THAT(describe(diagnosis), Contains(lines[2]));
  EXPECT_EQ(to_json(diagnosis)["sweep_direction"]["forward"]["ruled_out"], true);
  EXPECT_TRUE(describe_sweep_direction(sound_log().sweep_direction).empty());
}

TEST_F(DiagnosisReportTest, writes_json) {
  const auto json = to_json(mirrored_log());
  EXPECT_EQ(json["facts"]["scans"], 537);
  EXPECT_EQ(json["facts"]["time"]["first_s"], "1000.000000");
  EXPECT_EQ(json["odometry_check"]["sound"], false);
  EXPECT_EQ(json["odometry_check"]["heading"], "opposite");
  ASSERT_EQ(json["findings"].size(), 1U);
  EXPECT_EQ(json["findings"][0]["code"], "mirrored_scan");
  EXPECT_EQ(json["findings"][0]["severity"], "warning");
  EXPECT_EQ(json["findings"][0]["remedy"], "log.mirrored = true");

  const auto sound = to_json(sound_log());
  EXPECT_EQ(sound["beam_angles"]["best"], "left_open");
  EXPECT_EQ(sound["beam_angles"]["fits"].size(), 4U);
  EXPECT_TRUE(sound.contains("laser_mount_estimate"));
  EXPECT_TRUE(nlohmann::json::accept(sound.dump()));
}

}  // namespace
}  // namespace psi_slam
