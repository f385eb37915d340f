// SPDX-License-Identifier: BSD-3-Clause
#include "session/log_calibration.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "bag_files.h"
#include "logs/doctor/odometry_calibration.h"
#include "logs/frames/laser_choice.h"
#include "psi_slam/mapping_session.h"
#include "psi_slam/open_log.h"
#include "session/settings.h"
#include "simulated_run.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

OdometryCalibration well_determined() {
  OdometryCalibration calibration;
  calibration.delays = {{"", ScanDelay{100, 0.25, 0.005}}};
  LaserMountEstimate mount;
  mount.robot_T_laser = {0.2, 0.01, mrpt::DEG2RAD(1.5)};
  mount.deviation_m = 0.004;
  mount.deviation_rad = mrpt::DEG2RAD(0.1);
  mount.odometry_scale = 0.8;
  mount.scale_deviation = 0.002;
  calibration.mount = mount;
  return calibration;
}

/// Returns the options that log.calibrate leaves after these estimates.
LogOptions options_after(const LogCalibration& calibration, LogOptions options = {}) {
  options.calibrate = true;
  return calibrated_options(options, calibration);
}

TEST(LogCalibration, uses_what_the_log_determines) {
  const LogCalibration made = use_calibration(well_determined(), {});
  const LogOptions options = options_after(made);
  EXPECT_EQ(options.odometry_scale, 1.25);
  EXPECT_EQ(options.scan_delay_s, "0.25");
  EXPECT_EQ(options.robot_T_laser, TPose2D(0.2, 0.01, mrpt::DEG2RAD(1.5)));
  EXPECT_FALSE(calibrated_options({}, made).odometry_scale) << "without log.calibrate";
  EXPECT_EQ(made.estimates.size(), 5U);
  EXPECT_THAT(
      made.sentences,
      ElementsAre("log.calibrate estimates the scale of odometry: 1.2500 (standard deviation 0.0031), used",
                  "log.calibrate estimates the delay of scans: 0.250 s (standard deviation 0.005 s), used",
                  "log.calibrate estimates the pose of the laser: x 0.200 m, y 0.010 m, yaw 1.50 degrees "
                  "(standard deviations 0.004 m and 0.10 degrees), used"));
}

TEST(LogCalibration, uses_nothing_that_the_log_does_not_determine) {
  OdometryCalibration calibration = well_determined();
  calibration.delays.clear();
  calibration.mount->deviation_rad = 0.02;
  calibration.mount->scale_deviation = 0.01;
  const LogCalibration made = use_calibration(calibration, {});
  EXPECT_FALSE(options_after(made).odometry_scale);
  EXPECT_FALSE(options_after(made).robot_T_laser);
  ASSERT_EQ(made.estimates.size(), 4U);
  for (const CalibratedOption& estimate : made.estimates) EXPECT_FALSE(estimate.is_used);
  for (const std::string& sentence : made.sentences)
    EXPECT_THAT(sentence, HasSubstr("not used, because the log does not determine it"));
}

TEST(LogCalibration, uses_no_delay_that_may_be_zero) {
  for (const ScanDelay& delay : {ScanDelay{100, 0.01, 0.005}, ScanDelay{100, 0.25, 0.07}}) {
    OdometryCalibration calibration = well_determined();
    calibration.delays.front().delay = delay;
    const LogCalibration made = use_calibration(calibration, {});
    EXPECT_EQ(options_after(made).scan_delay_s, "auto");
    EXPECT_THAT(made.sentences[1], HasSubstr("not used, because it hardly differs from 0"));
  }
}

TEST(LogCalibration, keeps_a_stated_mount_that_may_be_right) {
  OdometryCalibration calibration = well_determined();
  calibration.stated_mount = {0.21, 0.005, mrpt::DEG2RAD(1.3)};
  const LogCalibration made = use_calibration(calibration, {});
  EXPECT_FALSE(options_after(made).robot_T_laser);
  EXPECT_THAT(made.sentences[2], HasSubstr("not used, because it hardly differs from the stated pose"));
}

TEST(LogCalibration, options_of_the_user_take_precedence) {
  LogOptions options;
  options.odometry_scale = 1.1;
  options.scan_delay_s = "0";
  options.laser_mounts = "FLASER 0.3 0 0";
  const LogCalibration made = use_calibration(well_determined(), options);
  EXPECT_EQ(options_after(made, options).odometry_scale, 1.1);
  EXPECT_EQ(options_after(made, options).scan_delay_s, "0");
  EXPECT_FALSE(options_after(made, options).robot_T_laser);
  EXPECT_THAT(made.estimates, IsEmpty());
  EXPECT_THAT(made.sentences, IsEmpty());
}

TEST(LogCalibration, leaves_several_lasers_and_says_what_prevents_it) {
  OdometryCalibration calibration = well_determined();
  calibration.several_lasers = true;
  const LogCalibration made = use_calibration(calibration, {});
  EXPECT_EQ(options_after(made).odometry_scale, 1.25);
  EXPECT_FALSE(options_after(made).robot_T_laser);
  EXPECT_EQ(made.sentences[2], "log.calibrate leaves the poses of several lasers unchanged");
  calibration.obstacle = "the log has no odometry";
  EXPECT_THAT(use_calibration(calibration, {}).sentences,
              ElementsAre("log.calibrate estimates nothing, because the log has no odometry"));
}

TEST(LogCalibration, uses_a_delay_for_each_laser) {
  OdometryCalibration calibration = well_determined();
  calibration.several_lasers = true;
  calibration.delays = {{"/front", ScanDelay{100, 0.25, 0.005}},
                        {"/rear", ScanDelay{100, 0.001, 0.005}},
                        {"/left", ScanDelay{100, -0.0625, 0.005}},
                        {"/right", std::nullopt}};
  const LogCalibration made = use_calibration(calibration, {});
  EXPECT_EQ(options_after(made).scan_delay_s, "/front 0.25, /left -0.0625");
  EXPECT_EQ(
      made.sentences[2],
      "log.calibrate estimates the delay of scans of /rear: 0.001 s (standard deviation 0.005 s), not used, "
      "because it hardly differs from 0");
  EXPECT_EQ(made.sentences[4], "log.calibrate finds no turns that show a delay of scans of /right below 1 s");
}

/// Recording of a robot whose laser is mounted backwards, but not by the transforms. The scans are on `topic`
/// and on `topic_of_copies`, which comes first.
Recording recording_backwards(const std::string& topic, const std::string& topic_of_copies) {
  SimulatedRun run = round_trips(2);
  run.robot_T_laser = {0.1, 0, M_PI};
  Recording recording{static_mount("laser", {0.1, 0, 0, 0, 0, 0})};
  for (std::size_t i = 0; i < run.truth.size(); ++i) {
    const TimeUs time_us = 1'600'000'000'000'000 + 200'000 * static_cast<TimeUs>(i);
    const TPose2D& pose = run.odometry[i];
    recording.emplace_back(
        RecordedPose{"/robot1/odom", time_us, "odom", "base_link", {pose.x, pose.y, 0, pose.phi, 0, 0}});
    RecordedScan scan;
    scan.topic = topic_of_copies;
    scan.time_us = time_us;
    scan.angle_min_rad = run.bearings_rad.front();
    scan.angle_increment_rad = run.bearings_rad[1] - run.bearings_rad[0];
    scan.ranges_m = run.ranges_m(i);
    recording.emplace_back(scan);
    scan.topic = topic;
    recording.emplace_back(scan);
  }
  return recording;
}

TEST(LogCalibration, of_a_mount_selects_the_laser_that_it_is_for) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "bag";
  for (const char* copies : {"/robot1/stable_scan", "/robot2/scan"}) {
    write_mcap(path, recording_backwards("/robot1/scan", copies));
    const LogCalibration made = calibrate_log(path, {});
    const LogOptions calibrated = calibrated_options({}, made);
    ASSERT_TRUE(calibrated.robot_T_laser) << copies;
    const auto log = open_log(path, calibrated);
    const auto frame = log->next();
    ASSERT_TRUE(frame && frame->has_odometry) << copies;
    EXPECT_NEAR(std::abs(frame->scan.robot_T_laser.phi), M_PI, 0.02) << copies;
  }
}

/// Log of a front and a rear laser whose scans are stamped late by different times.
std::string log_of_two_lasers(double front_delay_s, double rear_delay_s, bool rear_is_mirrored = false) {
  SimulatedRun front = with_late_stamps(round_trips(1), front_delay_s);
  SimulatedRun rear = with_late_stamps(round_trips(1), rear_delay_s);
  front.robot_T_laser = {0.2, 0, 0};
  rear.robot_T_laser = {-0.2, 0, M_PI};
  if (rear_is_mirrored)
    rear.put_into = [](std::vector<float>& ranges_m, std::size_t) {
      std::reverse(ranges_m.begin(), ranges_m.end());
    };
  std::string log = "PARAM robot_frontlaser_offset 0.2 host 1\nPARAM robot_rearlaser_offset -0.2 host 1\n";
  std::istringstream fronts(carmen_log(front));
  std::istringstream rears(carmen_log(rear));
  std::string front_line;
  std::string rear_line;
  while (std::getline(fronts, front_line) && std::getline(rears, rear_line)) {
    if (front_line.front() == '#') continue;
    rear_line.front() = 'R';
    log += front_line + '\n' + rear_line + '\n';
  }
  return log;
}

TEST(LogCalibration, estimates_the_delay_of_each_laser) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "two.log";
  write_file(path, log_of_two_lasers(0.3, 0.1));
  LogOptions options;
  options.calibrate = true;
  double last = 0;
  const LogCalibration made = calibrate_log(path, options, [&](double share) {
    EXPECT_GE(share, last);
    last = share;
  });
  EXPECT_NEAR(last, 1, 1e-9);
  const LogOptions calibrated = calibrated_options(options, made);
  const std::vector<StatedDelay> delays = stated_delays(calibrated);
  ASSERT_EQ(delays.size(), 2U) << calibrated.scan_delay_s;
  EXPECT_NEAR(delay_of_laser(delays, {"FLASER", "front"}), 0.3, 0.03);
  EXPECT_NEAR(delay_of_laser(delays, {"RLASER", "rear"}), 0.1, 0.03);
  EXPECT_EQ(made.estimates[1].laser, "FLASER");
  EXPECT_THAT(made.sentences, testing::Contains(HasSubstr("the delay of scans of RLASER: 0.")));

  // Scans that were measured at different times of one stamp show so in the odometry between them.
  const auto farthest_m = [&](const LogOptions& by) {
    double farthest = 0;
    const auto log = open_log(path, by);
    while (const auto frame = log->next())
      for (const CompanionScan& companion : frame->companions)
        farthest = std::max(farthest, companion.frame_T_robot.norm());
    return farthest;
  };
  EXPECT_LT(farthest_m({}), 1e-9);
  EXPECT_NEAR(farthest_m(calibrated), 0.08, 0.02) << "in 0.2 s at 0.4 m/s";
  LogOptions wrong;
  wrong.scan_delay_s = "LEFT 0.1";
  EXPECT_THAT(sentence_of([&] { open_log(path, wrong); }),
              HasSubstr("log.scan_delay_s is \"LEFT\", expected"));
}

TEST(LogCalibration, says_why_a_further_laser_gives_no_delay) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "two.log";
  write_file(path, log_of_two_lasers(0.3, 0.3, true));
  LogOptions options;
  options.calibrate = true;
  const LogCalibration made = calibrate_log(path, options);
  EXPECT_THAT(made.sentences, testing::Contains(HasSubstr("the delay of scans of FLASER: 0.")));
  EXPECT_THAT(made.sentences,
              testing::Contains("log.calibrate estimates no delay of scans of RLASER, because odometry "
                                "contradicts the scans. See psi-slam check"));
}

TEST(LogCalibration, leaves_the_mount_if_all_lasers_are_selected) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "one.log";
  SimulatedRun run = round_trips(1);
  run.robot_T_laser = {0.3, 0, 0};
  write_file(path, "PARAM robot_frontlaser_offset 0.0 host 1\n" + carmen_log(run));  // the wrong mount
  LogOptions options;
  options.calibrate = true;
  EXPECT_TRUE(calibrated_options(options, calibrate_log(path, options)).robot_T_laser);
  options.laser = "all";
  const LogOptions calibrated = calibrated_options(options, calibrate_log(path, options));
  EXPECT_FALSE(calibrated.robot_T_laser);
  EXPECT_TRUE(open_log(path, calibrated)->next());
}

/// Two rooms at the ends of a corridor of 50 m whose walls show no motion along it.
std::vector<Wall> rooms_with_a_bare_corridor() {
  std::vector<Wall> walls;
  for (const double side : {-1.0, 1.0}) {
    walls.push_back({0, side, 50, side});
    for (const auto& [door, wall] : {std::pair(0.0, -8.0), std::pair(50.0, 58.0)}) {
      walls.push_back({door, side, door, 3 * side});
      walls.push_back({door, 3 * side, wall, 3 * side});
      walls.push_back({wall, 3 * side, wall, 0});
    }
  }
  add_box(walls, -8, 1, -7.2, 2);
  add_box(walls, -4.5, -3, -3, -2.4);
  add_box(walls, 57.3, -1, 58, 0.5);
  add_box(walls, 53, 2.5, 54.2, 3);
  return walls;
}

constexpr double kWay_m = 58;  // from the middle of one room to that of the other

/// Two laps in the first room, through the corridor, and a lap in the second room. The scans of `begin` and
/// `end` are taken kWay_m apart.
struct CorridorRun {
  SimulatedRun run;
  std::size_t begin = 0;
  std::size_t end = 0;
};

CorridorRun corridor_run(double odometry_scale) {
  const RunPart left{0, 5, 18};
  const RunPart right{0, -5, 18};
  const auto ahead = [](double metres) {
    return RunPart{0.1, 0, static_cast<std::size_t>(std::lround(metres / 0.1))};
  };
  std::vector<RunPart> parts;
  for (int lap = 0; lap < 2; ++lap) {  // from (-6, 0), heading 0
    for (const RunPart& part :
         {right, ahead(1.5), left, ahead(4), left, ahead(3), left, ahead(4), left, ahead(1.5), left})
      parts.push_back(part);
  }
  CorridorRun result;
  for (const RunPart& part : parts) result.begin += part.steps;
  parts.push_back(ahead(kWay_m));
  result.end = result.begin + parts.back().steps;
  for (const RunPart& part :
       {right, ahead(1.5), left, ahead(4), left, ahead(3), left, ahead(4), left, ahead(1.5)})
    parts.push_back(part);
  result.run = simulated_run(parts, {-6, 0, 0});
  result.run.walls = rooms_with_a_bare_corridor();
  for (TPose2D& pose : result.run.odometry) {
    pose.x *= odometry_scale;
    pose.y *= odometry_scale;
  }
  return result;
}

class CorridorWithScaledOdometry : public testing::TestWithParam<double> {
 protected:
  CorridorWithScaledOdometry() {
    write_file(log_, carmen_log(simulated_.run));
    settings_.log.max_range_m = 15;
    // Far beams at grazing angles hit the walls at separate points. Matches of these points shorten the path.
    settings_.mapper.front_end.scan.max_range_m = 5;
  }

  /// Length of the way between the rooms in the map, divided by the true length.
  double mapped_share(MappingSession& session) {
    session.run(std::atomic<bool>(false));
    const auto& frames = session.result().frames;
    const TPose2D way = frames.at(simulated_.end).map_T_robot - frames.at(simulated_.begin).map_T_robot;
    return way.norm() / kWay_m;
  }

  CorridorRun simulated_ = corridor_run(GetParam());
  TemporaryFolder folder_;
  std::filesystem::path log_ = folder_.path() / "corridor.log";
  Settings settings_;
};

TEST_P(CorridorWithScaledOdometry, keeps_its_length_with_calibration) {
  settings_.log.calibrate = true;
  MappingSession session(log_, settings_);
  EXPECT_NEAR(mapped_share(session), 1, 0.005);
  EXPECT_THAT(session.warnings(), testing::Contains(HasSubstr("estimates the scale of odometry")));
  session.export_to(folder_.path() / "out");
  const auto summary = nlohmann::json::parse(read_file(folder_.path() / "out/summary.json"));
  const auto& scale = summary.at("calibration").at(0);
  EXPECT_EQ(scale.at("log"), "corridor.log");
  EXPECT_EQ(scale.at("option"), "log.odometry_scale");
  EXPECT_EQ(scale.at("used"), true);
  EXPECT_NEAR(scale.at("value"), 1 / GetParam(), 4 * scale.at("standard_deviation").get<double>());
  EXPECT_THAT(read_file(folder_.path() / "out/report.html"), HasSubstr("estimates the scale of odometry"));
}

TEST_P(CorridorWithScaledOdometry, is_too_short_or_too_long_without_calibration) {
  MappingSession session(log_, settings_);
  EXPECT_GT(std::abs(mapped_share(session) - 1), 0.03);
}

INSTANTIATE_TEST_SUITE_P(Scales, CorridorWithScaledOdometry, testing::Values(0.9, 1.1),
                         [](const auto& tested) { return tested.param < 1 ? "short" : "long"; });

}  // namespace
}  // namespace psi_slam
