// SPDX-License-Identifier: BSD-3-Clause
#include "logs/doctor/input_doctor.h"

#include <gmock/gmock.h>
#include <zlib.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>

#include "bag_files.h"
#include "log_files.h"
#include "rawlog_files.h"
#include "robot_body.h"
#include "shared_logs.h"
#include "simulated_run.h"
#include "swinging_robot.h"
#include "temporary_folder.h"
#include "two_lasers.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

std::vector<std::string> warnings_of(const LogDiagnosis& diagnosis) {
  std::vector<std::string> codes;
  for (const Finding& finding : diagnosis.findings)
    if (finding.severity == Severity::kWarning) codes.push_back(finding.code);
  return codes;
}

/// Returns the finding with this code, or an empty finding.
Finding finding_of(const LogDiagnosis& diagnosis, const std::string& code) {
  for (const Finding& finding : diagnosis.findings)
    if (finding.code == code) return finding;
  return {};
}

// ---- A simulated log with one fault at a time ----

class InputDoctorTest : public testing::Test {
 protected:
  LogDiagnosis diagnose_run(const SimulatedRun& run, const LogOptions& options = {}) {
    return diagnose_text(carmen_log(run), options);
  }

  LogDiagnosis diagnose_text(const std::string& log, const LogOptions& options = {}) {
    write_file(folder_.path() / "log.clf", log);
    return diagnose(folder_.path() / "log.clf", options);
  }

  TemporaryFolder folder_;
};

TEST_F(InputDoctorTest, judges_the_first_of_several_lasers) {
  const auto path = folder_.path() / "log";
  write_rawlog_of(path, {});
  LogOptions options;
  options.laser = "REAR,FRONT";
  const LogDiagnosis diagnosis = diagnose(path, options);
  EXPECT_EQ(diagnosis.facts.contents.laser, "REAR");
  EXPECT_EQ(diagnosis.facts.scans, 20U);
  EXPECT_EQ(diagnosis.facts.contents.other_lasers.at("FRONT"), 20U);
  EXPECT_EQ(diagnose(path).facts.contents.laser, "FRONT");
  write_carmen_of(path, {}, /*with_mounts=*/true);
  for (const char* lasers : {"", "all"}) {
    options.laser = lasers;
    EXPECT_EQ(diagnose(path, options).facts.contents.laser, "FLASER");
  }
}

TEST_F(InputDoctorTest, judges_a_truncated_bag_up_to_its_end) {
  const auto path = folder_.path() / "run.mcap";
  write_mcap(path, recorded_run(30));
  std::filesystem::resize_file(path, std::filesystem::file_size(path) * 2 / 3);
  const LogDiagnosis diagnosis = diagnose(path);
  EXPECT_THAT(diagnosis.facts.broken_off, testing::HasSubstr("run.mcap: byte"));
  EXPECT_THAT(diagnosis.facts.broken_off, testing::HasSubstr("the file is cut off"));
  EXPECT_GT(diagnosis.facts.scans, 8U);
  EXPECT_EQ(diagnosis.facts.format, "ROS 2 bag (MCAP)");
  EXPECT_EQ(diagnosis.facts.contents.laser, "/scan");
}

TEST_F(InputDoctorTest, finds_nothing_wrong_with_a_sound_log) {
  const SimulatedRun run = round_trips(2);
  const LogDiagnosis diagnosis = diagnose_run(run);
  EXPECT_THAT(warnings_of(diagnosis), testing::IsEmpty());
  EXPECT_TRUE(diagnosis.odometry_is_sound);
  EXPECT_EQ(diagnosis.facts.format, "CARMEN");
  EXPECT_EQ(diagnosis.facts.contents.laser, "FLASER");
  EXPECT_EQ(diagnosis.facts.scans, run.truth.size());
  EXPECT_EQ(diagnosis.facts.contents.messages.at("FLASER"), run.truth.size());
  EXPECT_EQ(diagnosis.used_beam_angles, BeamAngles::kLeftOpen);
  EXPECT_EQ(diagnosis.beam_angles.best, BeamAngles::kLeftOpen);
  EXPECT_EQ(finding_of(diagnosis, "beam_angles").sentence, "beam angles: left_open fits best, as used");
  EXPECT_EQ(diagnosis.findings.size(), 1U);
}

TEST_F(InputDoctorTest, finds_the_body_of_the_robot) {
  SimulatedRun run = round_trips(2);
  run.put_into = RobotBody::put_into;
  const std::string sentence =
      "8 beams from -45.0 to -38.0 degrees at 0.35 m, 2 beams from 45.0 to 46.0 degrees at 0.60 m see the "
      "robot itself";
  const LogDiagnosis diagnosis = diagnose_run(run);
  EXPECT_THAT(warnings_of(diagnosis), testing::IsEmpty());
  EXPECT_EQ(finding_of(diagnosis, "own_body").sentence,
            sentence + "; mapping ignores these readings unless log.mask_own_body = off");
  EXPECT_EQ(to_json(diagnosis)["own_body"].size(), 2U);
  EXPECT_EQ(to_json(diagnosis)["own_body"][0]["beams"], 8);

  LogOptions unmasked;
  unmasked.mask_own_body = false;
  const LogDiagnosis warned = diagnose_run(run, unmasked);
  EXPECT_THAT(warnings_of(warned), testing::ElementsAre("own_body"));
  EXPECT_EQ(finding_of(warned, "own_body").sentence, sentence);
  EXPECT_EQ(finding_of(warned, "own_body").remedy, "log.mask_own_body = auto");
}

TEST_F(InputDoctorTest, ignores_topics_for_other_formats) {
  LogOptions options;
  options.scan_topic = "/a,/b";
  const SimulatedRun run = round_trips(1);
  EXPECT_EQ(diagnose_run(run, options).facts.scans, run.truth.size());
  options.laser = "FLASER";
  EXPECT_EQ(diagnose_run(run, options).facts.contents.laser, "FLASER");
}

TEST_F(InputDoctorTest, detects_a_mirrored_scan_and_names_the_option) {
  SimulatedRun run = round_trips(1);
  for (float& bearing : run.bearings_rad) bearing = -bearing;
  const LogDiagnosis diagnosis = diagnose_run(run);
  EXPECT_THAT(warnings_of(diagnosis), testing::ElementsAre("mirrored_scan"));
  EXPECT_EQ(finding_of(diagnosis, "mirrored_scan").remedy, "log.mirrored = true");
  EXPECT_FALSE(diagnosis.odometry_is_sound);
  LogOptions mended;
  mended.mirrored = true;
  EXPECT_THAT(warnings_of(diagnose_run(run, mended)), testing::IsEmpty());
}

TEST_F(InputDoctorTest, detects_odometry_in_other_units) {
  for (const auto& [factor, name] : std::vector<std::pair<double, std::string>>{
           {1000, "millimetres"}, {100, "centimetres"}, {3.281, "feet"}, {0.001, "kilometres"}}) {
    SimulatedRun run = round_trips(1);
    for (TPose2D& pose : run.odometry) {
      pose.x *= factor;
      pose.y *= factor;
    }
    const LogDiagnosis diagnosis = diagnose_run(run);
    EXPECT_THAT(warnings_of(diagnosis), testing::ElementsAre("odometry_unit"));
    EXPECT_THAT(finding_of(diagnosis, "odometry_unit").sentence, testing::HasSubstr("looks like " + name));
  }
}

TEST_F(InputDoctorTest, detects_headings_in_degrees_and_clockwise_headings) {
  SimulatedRun run = round_trips(1);
  for (TPose2D& pose : run.odometry) pose.phi *= 180 / M_PI;
  EXPECT_THAT(warnings_of(diagnose_run(run)), testing::ElementsAre("odometry_degrees"));
  run = round_trips(1);
  for (TPose2D& pose : run.odometry) {
    pose = TPose2D{0, 0, 0.7} + pose;
    pose.phi = -pose.phi;
  }
  EXPECT_THAT(warnings_of(diagnose_run(run)), testing::ElementsAre("odometry_clockwise"));
}

TEST_F(InputDoctorTest, detects_constant_odometry) {
  SimulatedRun run = round_trips(1);
  for (TPose2D& pose : run.odometry) pose = {1, 2, 3};
  EXPECT_THAT(warnings_of(diagnose_run(run)), testing::ElementsAre("odometry_still"));
  const LogDiagnosis still = diagnose_run(simulated_run({{0, 0, 100}}));
  EXPECT_THAT(warnings_of(still), testing::IsEmpty());
  EXPECT_EQ(finding_of(still, "robot_still").sentence, "the robot stands still in the whole log");
}

TEST_F(InputDoctorTest, detects_a_wrong_laser_heading) {
  SimulatedRun run = round_trips(1);
  run.robot_T_laser = {0.1, 0, M_PI / 2};
  const LogDiagnosis diagnosis = diagnose_run(run);
  EXPECT_THAT(warnings_of(diagnosis), testing::Contains("laser_heading"));
  EXPECT_THAT(
      finding_of(diagnosis, "laser_heading").remedy,
      testing::MatchesRegex("log.laser_x_m = .*, log.laser_y_m = .*, log.laser_yaw_deg = (89|90)\\..*"));
  EXPECT_NEAR(diagnosis.mount->robot_T_laser.x, 0.1, 4 * diagnosis.mount->deviation_m);
}

TEST_F(InputDoctorTest, measures_the_mount_of_the_laser) {
  SimulatedRun run = round_trips(2);
  run.robot_T_laser = {0.2, 0, 0};
  const Finding finding = finding_of(diagnose_run(run), "laser_mount");
  EXPECT_EQ(finding.severity, Severity::kNote);
  double x_m = 0;
  ASSERT_EQ(std::sscanf(finding.remedy.c_str(), "log.laser_x_m = %lf", &x_m), 1) << finding.remedy;
  EXPECT_NEAR(x_m, 0.2, 0.02);
  LogOptions stated;
  stated.robot_T_laser = TPose2D{0.2, 0, 0};
  EXPECT_TRUE(finding_of(diagnose_run(run, stated), "laser_mount").sentence.empty());
}

TEST_F(InputDoctorTest, measures_the_scale_of_odometry) {
  SimulatedRun run = round_trips(2);
  for (TPose2D& pose : run.odometry) {
    pose.x *= 1.1;
    pose.y *= 1.1;
  }
  const Finding finding = finding_of(diagnose_run(run), "odometry_scale");
  double scale = 0;
  ASSERT_EQ(std::sscanf(finding.remedy.c_str(), "log.calibrate = true, or log.odometry_scale = %lf", &scale),
            1)
      << finding.remedy;
  EXPECT_NEAR(scale, 1 / 1.1, 0.005);
  LogOptions stated;
  stated.odometry_scale = 1 / 1.1;
  EXPECT_TRUE(finding_of(diagnose_run(run, stated), "odometry_scale").sentence.empty());
  stated.odometry_scale = 0.8;
  EXPECT_THAT(finding_of(diagnose_run(run, stated), "odometry_scale").remedy,
              testing::StartsWith("log.odometry_scale = 0.9"))
      << "log.calibrate estimates no stated option";
}

TEST_F(InputDoctorTest, measures_the_delay_of_scans) {
  const SimulatedRun run = with_late_stamps(round_trips(2), 0.25);
  const Finding finding = finding_of(diagnose_run(run), "scan_delay");
  EXPECT_EQ(finding.severity, Severity::kWarning);
  double delay_s = 0;
  ASSERT_EQ(std::sscanf(finding.remedy.c_str(), "log.calibrate = true, or log.scan_delay_s = %lf", &delay_s),
            1)
      << finding.remedy;
  EXPECT_NEAR(delay_s, 0.25, 0.03);
  LogOptions stated;
  stated.scan_delay_s = "0.25";
  EXPECT_TRUE(finding_of(diagnose_run(run, stated), "scan_delay").sentence.empty());
  stated.scan_delay_s = "0.1";
  EXPECT_THAT(finding_of(diagnose_run(run, stated), "scan_delay").remedy,
              testing::StartsWith("log.scan_delay_s = 0.2"))
      << "log.calibrate estimates no stated option";
  LogOptions all;
  all.laser = "all";
  EXPECT_THAT(finding_of(diagnose_run(run, all), "scan_delay").remedy,
              testing::StartsWith("log.calibrate = true, or log.scan_delay_s = FLASER 0.2"));
}

TEST_F(InputDoctorTest, uses_the_stated_delay_of_a_laser_whose_scans_come_late_in_the_log) {
  std::string head;
  for (int line = 0; line < 600; ++line) head += "# line " + std::to_string(line) + '\n';
  const std::string log = head + carmen_log(with_late_stamps(round_trips(2), 0.25));
  LogOptions stated;
  stated.scan_delay_s = "FLASER 0.25";
  EXPECT_TRUE(finding_of(diagnose_text(log, stated), "scan_delay").sentence.empty());
  stated.scan_delay_s = "FLASER 0.1";
  EXPECT_FALSE(finding_of(diagnose_text(log, stated), "scan_delay").sentence.empty());
}

TEST_F(InputDoctorTest, detects_wrong_beam_angles) {
  SimulatedRun run = round_trips(2);
  run.bearings_rad = make_bearings_rad(BeamAngles::kSkipZero, 180, M_PI);
  const LogDiagnosis diagnosis = diagnose_run(run);
  EXPECT_EQ(finding_of(diagnosis, "beam_angles").severity, Severity::kWarning);
  EXPECT_EQ(finding_of(diagnosis, "beam_angles").remedy, "log.beam_angles = skip_zero");
  LogOptions mended;
  mended.beam_angles = BeamAngles::kSkipZero;
  EXPECT_EQ(finding_of(diagnose_run(run, mended), "beam_angles").sentence,
            "beam angles: skip_zero fits best, as used");
}

TEST_F(InputDoctorTest, detects_corrected_odometry) {
  SimulatedRun run = round_trips(3);
  run.odometry = run.truth;
  EXPECT_THAT(warnings_of(diagnose_run(run)), testing::ElementsAre("corrected_odometry"));
}

TEST_F(InputDoctorTest, reports_a_second_pose) {
  std::string log = carmen_log(round_trips(1));
  const std::string pose = " 0.000000 0.000000 0.000000";
  const std::size_t first_pose = log.find(pose + pose);
  ASSERT_NE(first_pose, std::string::npos);
  log.replace(first_pose, pose.size(), " 0.100000 0.000000 0.000000");
  EXPECT_THAT(finding_of(diagnose_text(log), "two_poses").sentence,
              testing::StartsWith("1 scan has a second pose"));
}

/// A CARMEN log that states no maximum range, with `code` for all readings beyond 6 m.
std::string log_with_code(const std::string& code) {
  std::string log;
  std::istringstream lines(carmen_log(round_trips(1)));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line);
    std::string message;
    std::size_t readings = 0;
    fields >> message >> readings;
    if (message != "FLASER") continue;
    log += "FLASER 180";
    for (std::size_t i = 0; i < readings; ++i) {
      double range = 0;
      fields >> range;
      log += " " + (range > 6 ? code : std::to_string(range));
    }
    std::string rest;
    std::getline(fields, rest);
    log += rest + "\n";
  }
  return log;
}

TEST_F(InputDoctorTest, detects_the_code_for_no_return) {
  const std::string log = log_with_code("8.000000");
  const LogDiagnosis diagnosis = diagnose_text(log);
  EXPECT_THAT(warnings_of(diagnosis), testing::IsEmpty());
  EXPECT_THAT(finding_of(diagnosis, "no_return_code").sentence, testing::HasSubstr("writes 8.00 m"));
  EXPECT_NEAR(diagnosis.facts.ranges.max_range_m, 7.995, 1e-6);
  EXPECT_LT(diagnosis.facts.ranges.return_share(), 1);
  LogOptions stated;
  stated.max_range_m = 8.0;
  EXPECT_EQ(finding_of(diagnose_text(log, stated), "no_return_code").sentence, "");
  EXPECT_THAT(warnings_of(diagnose_text(log, stated)), testing::IsEmpty());
  stated.max_range_m = 8.01;
  const LogDiagnosis overruled = diagnose_text(log, stated);
  EXPECT_THAT(warnings_of(overruled), testing::ElementsAre("max_range"));
  EXPECT_EQ(finding_of(overruled, "max_range").sentence,
            "the laser writes 8.00 m for \"no return\", but log.max_range_m is 8.01 m");
  EXPECT_EQ(finding_of(overruled, "max_range").remedy, "log.max_range_m = auto");
  EXPECT_NEAR(overruled.facts.ranges.max_range_m, 8.01, 1e-6);
}

// The log states no maximum, so a code of 50 m or more surprises nobody, but the user's maximum lets it pass.
TEST_F(InputDoctorTest, warns_of_a_stated_maximum_beyond_a_code_of_50_m_or_more) {
  const std::string log = log_with_code("81.910000");
  EXPECT_EQ(finding_of(diagnose_text(log), "no_return_code").sentence, "");
  EXPECT_NEAR(diagnose_text(log).max_range.code_m, 81.91, 1e-6);
  LogOptions stated;
  stated.max_range_m = 100;
  EXPECT_EQ(finding_of(diagnose_text(log, stated), "max_range").sentence,
            "the laser writes 81.91 m for \"no return\", but log.max_range_m is 100.00 m");
  stated.max_range_m = 80;
  EXPECT_EQ(finding_of(diagnose_text(log, stated), "max_range").sentence, "");
}

TEST_F(InputDoctorTest, names_the_code_that_mapping_uses) {
  SimulatedRun run = round_trips(1);
  run.put_into = [](std::vector<float>& ranges_m, std::size_t) {
    for (float& range_m : ranges_m)
      if (range_m > 6) range_m = 8.18F;
  };
  const auto path = folder_.path() / "codes.log";
  write_file(path, "PARAM robot_front_laser_max 8.19 host 0\n" + carmen_log(run));
  const auto log = open_log(path);
  const auto first = log->next();
  ASSERT_TRUE(first);
  const LogDiagnosis diagnosis = diagnose(path);
  EXPECT_EQ(first->scan.max_range_m, diagnosis.facts.ranges.max_range_m);
  EXPECT_THAT(log->assumptions(), testing::ElementsAre(finding_of(diagnosis, "no_return_code").sentence));
}

TEST_F(InputDoctorTest, detects_ranges_in_millimetres_or_centimetres) {
  const SimulatedRun run = round_trips(1);
  for (const std::string maximum : {"PARAM robot_front_laser_max 80 host 0\n", ""}) {
    for (const float units_per_m : {1000.0F, 100.0F}) {
      std::string log = maximum;
      for (std::size_t i = 0; i < run.truth.size(); ++i) {
        log += "FLASER 180";
        for (const float range : run.ranges_m(i))
          log += " " + std::to_string(std::lround(range * units_per_m));
        const std::string pose = " " + std::to_string(run.odometry[i].x) + " " +
                                 std::to_string(run.odometry[i].y) + " " +
                                 std::to_string(run.odometry[i].phi);
        log += pose + pose + " " + std::to_string(i) + " host 0\n";
      }
      EXPECT_THAT(warnings_of(diagnose_text(log)), testing::Contains("range_unit")) << maximum << units_per_m;
    }
  }
}

TEST_F(InputDoctorTest, detects_a_maximum_range_that_is_too_small) {
  LogOptions options;
  options.max_range_m = 0.9;
  EXPECT_THAT(warnings_of(diagnose_run(round_trips(1), options)),
              testing::AllOf(testing::Contains("few_returns"), testing::Contains("empty_scans")));
}

TEST_F(InputDoctorTest, detects_repeated_scans) {
  std::string log = carmen_log(round_trips(1));
  const std::size_t start = log.find("FLASER", log.size() / 2);
  const std::size_t end = log.find('\n', start) + 1;
  log.insert(end, log.substr(start, end - start));
  const LogDiagnosis diagnosis = diagnose_text(log);
  EXPECT_THAT(warnings_of(diagnosis), testing::ElementsAre("repeated_scans"));
  EXPECT_THAT(finding_of(diagnosis, "repeated_scans").sentence, testing::StartsWith("1 scan repeat"));
}

TEST_F(InputDoctorTest, reports_malformed_lines) {
  const std::string log = carmen_log(round_trips(1));
  const LogDiagnosis diagnosis = diagnose_text("FLASER 3 1.0\n" + log);
  EXPECT_EQ(diagnosis.facts.contents.skipped.count, 1U);
  EXPECT_THAT(warnings_of(diagnosis), testing::IsEmpty()) << "one malformed line is no warning";
  EXPECT_THAT(finding_of(diagnosis, "skipped_lines").sentence,
              testing::AllOf(testing::StartsWith("1 message of the log"), testing::HasSubstr(":1: FLASER")));
}

TEST_F(InputDoctorTest, needs_no_odometry) {
  write_file(folder_.path() / "log.clf", carmen_log(round_trips(1)));
  LogOptions none;
  none.odometry = "none";
  const LogDiagnosis diagnosis = diagnose(folder_.path() / "log.clf", none);
  EXPECT_THAT(warnings_of(diagnosis), testing::IsEmpty());
  EXPECT_THAT(finding_of(diagnosis, "no_odometry").sentence,
              testing::StartsWith("the scans are read without odometry"));
}

TEST_F(InputDoctorTest, reads_rawlogs_too) {
  const SimulatedRun run = round_trips(1);
  RawlogObjects objects;
  for (std::size_t i = 0; i < run.truth.size(); ++i) {
    const TPose2D increment = i == 0 ? TPose2D{0, 0, 0} : run.odometry[i] - run.odometry[i - 1];
    auto scan = range_scan(static_cast<TimeUs>(1'000'000 + i * 200'000), "LASER", run.ranges_m(i));
    scan->aperture = static_cast<float>(M_PI);
    scan->rightToLeft = true;
    objects.push_back(movement(mrpt::poses::CPose2D(increment)));
    objects.push_back(sensory_frame({scan, range_scan(1'000'000, "OTHER")}));
  }
  write_rawlog(folder_.path() / "log.rawlog", objects);
  const LogDiagnosis diagnosis = diagnose(folder_.path() / "log.rawlog");
  EXPECT_EQ(diagnosis.facts.format, "MRPT rawlog");
  EXPECT_EQ(diagnosis.facts.contents.laser, "LASER");
  EXPECT_EQ(diagnosis.facts.contents.other_lasers.at("OTHER"), run.truth.size());
  EXPECT_EQ(diagnosis.used_beam_angles, BeamAngles::kAuto) << "the log states its angles";
  EXPECT_TRUE(diagnosis.beam_angles.fits.empty());
  EXPECT_TRUE(diagnosis.odometry_is_sound);
  EXPECT_THAT(warnings_of(diagnosis), testing::IsEmpty());
}

TEST_F(InputDoctorTest, finds_the_direction_of_the_sweep) {
  const auto path = folder_.path() / "run.mcap";
  const auto diagnose_with = [&](SweepDirection direction) {
    LogOptions options;
    options.sweep_direction = direction;
    return diagnose(path, options);
  };
  write_mcap(path, swinging_robot({SwingingLaser{"/scan", true}}));
  const LogDiagnosis backward = diagnose_with(SweepDirection::kAuto);
  EXPECT_THAT(warnings_of(backward), testing::IsEmpty()) << "mapping finds the direction by itself";
  const Finding finding = finding_of(backward, "sweep_direction");
  EXPECT_EQ(finding.sentence,
            "turns show that the last beam of each scan is measured first, but the log states the first; "
            "mapping corrects this");
  EXPECT_EQ(finding.remedy, "log.sweep_direction = backward");
  EXPECT_THAT(warnings_of(diagnose_with(SweepDirection::kForward)), testing::ElementsAre("sweep_direction"));
  const LogDiagnosis mended = diagnose_with(SweepDirection::kBackward);
  EXPECT_THAT(finding_of(mended, "sweep_direction").sentence, testing::HasSubstr("first, as used"));
  EXPECT_THAT(warnings_of(mended), testing::IsEmpty());

  write_mcap(path, swinging_robot({SwingingLaser{}}));
  EXPECT_THAT(finding_of(diagnose_with(SweepDirection::kAuto), "sweep_direction").sentence,
              testing::HasSubstr("the first beam of each scan is measured first, as used"));
  EXPECT_EQ(finding_of(diagnose_with(SweepDirection::kBackward), "sweep_direction").remedy,
            "log.sweep_direction = forward");
}

TEST_F(InputDoctorTest, finds_a_sweep_time_that_the_scans_contradict) {
  const auto path = folder_.path() / "run.mcap";
  write_mcap(path, swinging_robot({SwingingLaser{"/scan", false, 0}}));
  const LogDiagnosis diagnosis = diagnose(path);
  EXPECT_THAT(warnings_of(diagnosis), testing::ElementsAre("sweep_time"));
  EXPECT_EQ(finding_of(diagnosis, "sweep_time").remedy, "log.sweep_time_s = 0");
  LogOptions mended;
  mended.sweep_time_s = 0;
  EXPECT_THAT(warnings_of(diagnose(path, mended)), testing::IsEmpty());
}

TEST_F(InputDoctorTest, diagnoses_logs_of_one_scan_or_two) {
  for (const std::size_t steps : {0, 1}) {
    const LogDiagnosis diagnosis = diagnose_run(simulated_run({{0.1, 0, steps}}));
    EXPECT_EQ(diagnosis.facts.scans, steps + 1);
    EXPECT_THAT(warnings_of(diagnosis), testing::IsEmpty());
  }
}

TEST_F(InputDoctorTest, judges_a_truncated_log_up_to_its_end) {
  std::string log = carmen_log(round_trips(1));
  const LogDiagnosis whole = diagnose_text(log);
  EXPECT_EQ(whole.facts.broken_off, "");
  const LogDiagnosis diagnosis = diagnose_text(log + "FLASER 181 1.0");
  EXPECT_EQ(diagnosis.facts.scans, whole.facts.scans);
  EXPECT_TRUE(diagnosis.odometry_is_sound);
  EXPECT_THAT(diagnosis.facts.broken_off, testing::HasSubstr("the file is cut off in this line"));
  ASSERT_THAT(warnings_of(diagnosis), testing::ElementsAre("broken_off"));
  EXPECT_EQ(diagnosis.findings.front().code, "broken_off");
  EXPECT_THAT(
      diagnosis.findings.front().sentence,
      testing::AllOf(testing::StartsWith(diagnosis.facts.broken_off),
                     testing::EndsWith(std::to_string(whole.facts.scans) + " scans that could be read")));
}

TEST_F(InputDoctorTest, passes_on_the_error_of_an_unreadable_log) {
  EXPECT_THROW(diagnose(folder_.path() / "none"), UserError);
  EXPECT_THROW(diagnose_text("FLASER 3 1 2\n"), UserError);
}

// ---- The benchmark logs, unchanged and with faults ----

/// Copies the first `scans` FLASER lines of a log. `change` modifies the ranges and the odometry pose (x, y,
/// heading) of each line.
void rewrite(const std::filesystem::path& from, const std::filesystem::path& to, std::size_t scans,
             const std::function<void(std::vector<std::string>& ranges, TPose2D& odometry)>& change) {
  gzFile file = gzopen(from.c_str(), "rb");
  std::vector<char> buffer(1 << 16);
  std::string log;
  while (scans > 0 && gzgets(file, buffer.data(), static_cast<int>(buffer.size())) != nullptr) {
    std::istringstream fields(buffer.data());
    std::string message;
    std::size_t readings = 0;
    fields >> message >> readings;
    if (message != "FLASER") continue;
    --scans;
    std::vector<std::string> ranges(readings);
    for (std::string& range : ranges) fields >> range;
    TPose2D pose;
    fields >> pose.x >> pose.y >> pose.phi >> pose.x >> pose.y >> pose.phi;
    change(ranges, pose);
    log += "FLASER " + std::to_string(readings);
    for (const std::string& range : ranges) log += " " + range;
    char text[200];
    std::snprintf(text, sizeof text, " %.9g %.9g %.9g %.9g %.9g %.9g", pose.x, pose.y, pose.phi, pose.x,
                  pose.y, pose.phi);
    std::string stamps;
    std::getline(fields, stamps);
    log += text + stamps + "\n";
  }
  gzclose(file);
  write_file(to, log);
}

class InputDoctorOnKnownLogs : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    const auto found = shared_file(std::string(GetParam()) + ".clf.gz");
    if (!found) GTEST_SKIP() << kNeedsData;
    log_ = *found;
  }

  std::vector<std::string> warnings_when(
      const std::function<void(std::vector<std::string>& ranges, TPose2D& odometry)>& change) {
    const auto path = folder_.path() / "spoilt.clf";
    rewrite(log_, path, 3000, change);
    return warnings_of(diagnose(path));
  }

  TemporaryFolder folder_;
  std::filesystem::path log_;
};

TEST_P(InputDoctorOnKnownLogs, raises_no_false_alarm) {
  const LogDiagnosis diagnosis = diagnose(log_);
  EXPECT_TRUE(diagnosis.odometry_is_sound);
  ASSERT_TRUE(diagnosis.mount);
  EXPECT_LT(diagnosis.mount->robot_T_laser.norm(), 0.15);
  const std::string name = GetParam();
  std::vector<std::string> warnings = warnings_of(diagnosis);
  const auto late = std::find(warnings.begin(), warnings.end(), "scan_delay");
  EXPECT_EQ(late != warnings.end(), name == "fr079" || name == "mit-csail" || name == "mit-killian");
  if (late != warnings.end()) warnings.erase(late);
  if (name == "fr079") {
    EXPECT_THAT(warnings, testing::ElementsAre("lost_reversals"));
    EXPECT_GT(diagnosis.reversals.reversed_m, 3.0) << "the log reverses by 9.6 m";
    EXPECT_LT(diagnosis.reversals.reversed_m, 10.0);
  } else {
    EXPECT_THAT(warnings, testing::IsEmpty());
    EXPECT_EQ(diagnosis.reversals.pairs.size(), 0U);
  }
}

TEST_P(InputDoctorOnKnownLogs, rules_out_skip_zero) {
  const LogDiagnosis diagnosis = diagnose(log_);
  ASSERT_FALSE(diagnosis.beam_angles.fits.empty());
  for (const BeamAngleFit& fit : diagnosis.beam_angles.fits)
    EXPECT_EQ(fit.ruled_out_by_walls, fit.angles == BeamAngles::kSkipZero) << name_of(fit.angles);
}

TEST_P(InputDoctorOnKnownLogs, detects_a_mirrored_scan) {
  EXPECT_THAT(warnings_when([](auto& ranges, TPose2D&) { std::reverse(ranges.begin(), ranges.end()); }),
              testing::ElementsAre("mirrored_scan"));
}

TEST_P(InputDoctorOnKnownLogs, detects_millimetres_and_centimetres) {
  for (const double factor : {1000.0, 100.0})
    EXPECT_THAT(warnings_when([&](auto&, TPose2D& pose) {
                  pose.x *= factor;
                  pose.y *= factor;
                }),
                testing::ElementsAre("odometry_unit"));
}

TEST_P(InputDoctorOnKnownLogs, detects_degrees) {
  EXPECT_THAT(warnings_when([](auto&, TPose2D& pose) { pose.phi *= 180 / M_PI; }),
              testing::ElementsAre("odometry_degrees"));
}

TEST_P(InputDoctorOnKnownLogs, detects_clockwise_headings) {
  EXPECT_THAT(warnings_when([](auto&, TPose2D& pose) { pose.phi = -pose.phi; }),
              testing::ElementsAre("odometry_clockwise"));
}

TEST_P(InputDoctorOnKnownLogs, detects_constant_odometry) {
  EXPECT_THAT(warnings_when([](auto&, TPose2D& pose) {
                pose = {0, 0, 0};
              }),
              testing::ElementsAre("odometry_still"));
}

INSTANTIATE_TEST_SUITE_P(all, InputDoctorOnKnownLogs,
                         testing::Values("aces", "intel", "mit-killian", "mit-csail", "fr079"),
                         [](const auto& test) {
                           std::string name = test.param;
                           for (char& c : name)
                             if (c == '-') c = '_';
                           return name;
                         });

TEST(InputDoctorOnIntel, notes_time_that_runs_backwards) {
  const auto log = shared_file("intel.clf.gz");
  if (!log) GTEST_SKIP() << kNeedsData;
  const LogDiagnosis diagnosis = diagnose(*log);
  const Finding finding = finding_of(diagnosis, "time_backwards");
  EXPECT_EQ(finding.severity, Severity::kNote);
  EXPECT_EQ(finding.sentence,
            "time runs backwards at 858 scans, by up to 0.897 s; scans keep the order of the file");
  EXPECT_GE(diagnosis.beam_angles.full_turns, 2U);
  for (const BeamAngleFit& fit : diagnosis.beam_angles.fits)
    if (fit.angles == BeamAngles::kCentredStepInclusive) {
      EXPECT_TRUE(fit.ruled_out_by_turns);
    }
}

}  // namespace
}  // namespace psi_slam
