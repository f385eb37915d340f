// SPDX-License-Identifier: BSD-3-Clause
#include "doctor/pair_calibration.h"

#include <gtest/gtest.h>

#include "log_files.h"
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

}  // namespace
}  // namespace psi_slam
