// SPDX-License-Identifier: BSD-3-Clause
#include "logs/doctor/pair_calibration.h"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "log_files.h"
#include "logs/doctor/input_doctor.h"
#include "logs/doctor/odometry_calibration.h"
#include "logs/doctor/quick_check.h"
#include "psi_slam/open_log.h"
#include "simulated_run.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using mrpt::DEG2RAD;
using mrpt::math::TPose2D;

std::optional<LaserMountEstimate> turned_mount_of(const TPose2D& true_mount, const TPose2D& stated_mount,
                                                  double odometry_turned_rad = 0) {
  SimulatedRun run = round_trips(1);
  for (TPose2D& pose : run.odometry) pose.phi += odometry_turned_rad;
  run.bearings_rad = make_bearings_rad(BeamAngles::kLeftOpen, 180, 2 * M_PI);
  run.robot_T_laser = true_mount;
  const TemporaryFolder folder;
  write_file(folder.path() / "log", carmen_log(run));
  std::vector<FrameMark> marks;
  for (const TPose2D& pose : run.odometry)
    marks.push_back({200'000 * static_cast<TimeUs>(marks.size()), pose});
  LogOptions options;
  options.field_of_view_rad = 2 * M_PI;
  options.robot_T_laser = stated_mount;
  const auto tracks = tracks_from(frames_in_motion(marks, 60), marks.size());
  const auto pairs = calibration_pairs(marks);
  ScanLibrary library;
  for (const auto& track : tracks) library.want(track);
  library.want(pairs);
  library.fetch(folder.path() / "log", options);
  const OdometryAgreement odometry = check_odometry(marks, tracks, library);
  const PairCalibration found = calibrate_by_pairs(odometry, marks, marks, stated_mount, pairs, library);
  return found.laser_is_turned ? found.mount : std::nullopt;
}

TEST(TurnedLaser, has_the_true_mount_within_its_standard_deviations) {
  for (const double yaw_deg : {180.0, 172.0, -90.0, 45.0, 25.0}) {
    for (const TPose2D& stated : {TPose2D{0.25, 0, 0}, TPose2D{0, 0, 0}}) {
      const TPose2D truth{0.25, -0.05, DEG2RAD(yaw_deg)};
      const auto found = turned_mount_of(truth, stated);
      ASSERT_TRUE(found) << yaw_deg;
      EXPECT_NEAR(found->robot_T_laser.x, truth.x, 4 * found->deviation_m) << yaw_deg;
      EXPECT_NEAR(found->robot_T_laser.y, truth.y, 4 * found->deviation_m) << yaw_deg;
      EXPECT_NEAR(mrpt::math::wrapToPi(found->robot_T_laser.phi - truth.phi), 0, 4 * found->deviation_rad);
      EXPECT_LT(found->deviation_m, 0.02);
      EXPECT_LT(found->deviation_rad, DEG2RAD(0.5));
    }
  }
}

TEST(TurnedLaser, is_not_found_where_the_heading_is_about_right) {
  for (const double off_deg : {0.0, 3.0, -8.0})
    EXPECT_FALSE(turned_mount_of({0.25, 0, DEG2RAD(off_deg)}, {0.2, 0, 0})) << off_deg;
}

TEST(TurnedLaser, is_not_found_where_the_headings_of_odometry_may_be_wrong) {
  for (const double off_deg : {40.0, -90.0})
    EXPECT_FALSE(turned_mount_of({0.25, 0, 0}, {0.25, 0, 0}, DEG2RAD(off_deg))) << off_deg;
}

/// A log with a delay, and odometry and a laser that differ from what the log states.
struct WrongLog {
  SimulatedRun run;
  double delay_s = 0;
  double odometry_scale = 1;
};

WrongLog wrong_log(unsigned seed) {
  WrongLog log{round_trips(2, seed), 0.1 * (seed % 7) - 0.3, 0.88 + 0.06 * (seed % 5)};
  log.run.seed = seed;
  log.run.robot_T_laser = {0.25, -0.05, DEG2RAD(2.0)};
  log.run = with_late_stamps(log.run, log.delay_s);
  for (TPose2D& pose : log.run.odometry) {
    pose.x *= log.odometry_scale;
    pose.y *= log.odometry_scale;
  }
  return log;
}

LogDiagnosis diagnosis_of(const SimulatedRun& run, const std::filesystem::path& path) {
  write_file(path, carmen_log(run));
  return diagnose(path);
}

TEST(PairCalibration, has_the_truth_within_its_standard_deviations) {
  constexpr unsigned kLogs = 10;
  const TemporaryFolder folder;
  std::map<std::string, double> squares;
  for (unsigned seed = 1; seed <= kLogs; ++seed) {
    const WrongLog log = wrong_log(seed);
    const LogDiagnosis found = diagnosis_of(log.run, folder.path() / "log");
    ASSERT_TRUE(found.delay && found.mount) << seed;
    const LaserMountEstimate& mount = *found.mount;
    const TPose2D off = mount.robot_T_laser - log.run.robot_T_laser;
    const std::map<std::string, double> errors{
        {"delay", (found.delay->delay_s - log.delay_s) / found.delay->deviation_s},
        {"position", off.norm() / std::sqrt(2) / mount.deviation_m},
        {"heading", off.phi / mount.deviation_rad},
        {"scale", (mount.odometry_scale - log.odometry_scale) / mount.scale_deviation}};
    for (const auto& [name, error] : errors) {
      EXPECT_LT(std::abs(error), 4) << name << " with seed " << seed;
      squares[name] += error * error / kLogs;
    }
    EXPECT_LT(found.delay->deviation_s, 0.03);
    EXPECT_LT(mount.deviation_m, 0.02);
    EXPECT_LT(mount.deviation_rad, DEG2RAD(0.3));
    EXPECT_LT(mount.scale_deviation, 0.01);
  }
  for (const auto& [name, square] : squares) {
    EXPECT_LT(std::sqrt(square), 1.6) << name;
    // The scale is stated no better than lasers measure. Simulated ranges are exact.
    EXPECT_GT(std::sqrt(square), name == "scale" ? 0 : 0.4) << name;
  }
}

TEST(PairCalibration, is_the_same_by_check_at_the_end_of_a_run_and_by_calibration) {
  const TemporaryFolder folder;
  for (const double delay_s : {-0.27, 0.16}) {
    const auto path = folder.path() / "log";
    const LogDiagnosis found = diagnosis_of(with_late_stamps(round_trips(2), delay_s), path);
    ASSERT_TRUE(found.delay);
    EXPECT_NEAR(found.delay->delay_s, delay_s, 4 * found.delay->deviation_s);
    std::vector<Frame> frames;
    const auto log = open_log(path);
    while (auto frame = log->next()) frames.push_back(std::move(*frame));
    EXPECT_THAT(
        quick_check(frames, 0, frames.size(), {}),
        testing::Contains(testing::HasSubstr(
            fixed_text(std::abs(found.delay->delay_s), 3) + (delay_s > 0 ? " s later" : " s earlier") +
            " than odometry (accurate to " + fixed_text(found.delay->deviation_s, 3) + " s)")));
    const OdometryCalibration calibration = calibrate_odometry(path, {});
    ASSERT_TRUE(calibration.delays.front().delay);
    EXPECT_NEAR(calibration.delays.front().delay->delay_s, found.delay->delay_s, 1e-3);
    EXPECT_NEAR(calibration.delays.front().delay->deviation_s, found.delay->deviation_s, 1e-3);
  }
}

}  // namespace
}  // namespace psi_slam
