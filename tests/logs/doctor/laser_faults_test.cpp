// SPDX-License-Identifier: BSD-3-Clause
#include "logs/doctor/laser_faults.h"

#include <gtest/gtest.h>
#include <mrpt/core/bits_math.h>

#include <cctype>

#include "log_files.h"
#include "shared_logs.h"
#include "simulated_run.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

TEST(LaserFaults, are_wrong_fields_of_view_and_turned_lasers) {
  const auto wrong = shared_file("faults/wrong_fov.log.gz");
  const auto backwards = shared_file("faults/laser_backwards.db3.zstd");
  if (!wrong || !backwards) GTEST_SKIP() << kNeedsData;
  const LaserFaults of_view = find_laser_faults(*wrong, {});
  ASSERT_TRUE(of_view.field_of_view_rad);
  EXPECT_NEAR(*of_view.field_of_view_rad, M_PI, 1e-9);
  EXPECT_FALSE(of_view.mount);
  EXPECT_EQ(of_view.assumed_for_beams, 0U);
  const LaserFaults of_mount = find_laser_faults(*backwards, {});
  ASSERT_TRUE(of_mount.mount);
  EXPECT_FALSE(of_mount.field_of_view_rad);
  const LaserMountEstimate& mount = *of_mount.mount;
  EXPECT_NEAR(mount.robot_T_laser.x, 0.25, 4 * mount.deviation_m);
  EXPECT_NEAR(mount.robot_T_laser.y, 0, 4 * mount.deviation_m);
  EXPECT_NEAR(std::abs(mount.robot_T_laser.phi), M_PI, 4 * mount.deviation_rad);
}

TEST(LaserFaults, are_found_for_each_heading_and_field_of_view) {
  const TemporaryFolder folder;
  const auto faults_of = [&](const SimulatedRun& run) {
    write_file(folder.path() / "log", carmen_log(run));
    return find_laser_faults(folder.path() / "log", {});
  };
  SimulatedRun run = round_trips(2);
  EXPECT_FALSE(faults_of(run).mount);
  for (const double yaw_deg : {180.0, 90.0, -90.0, 45.0}) {
    run.robot_T_laser = {0.1, 0, mrpt::DEG2RAD(yaw_deg)};
    const LaserFaults faults = faults_of(run);
    ASSERT_TRUE(faults.mount) << yaw_deg;
    EXPECT_NEAR(mrpt::math::wrapToPi(faults.mount->robot_T_laser.phi - run.robot_T_laser.phi), 0, 0.01);
  }
  run = round_trips(2);
  for (const double true_deg : {90.0, 360.0}) {  // not 180, as is usual for 180 beams
    run.bearings_rad = make_bearings_rad(BeamAngles::kLeftOpen, 180, mrpt::DEG2RAD(true_deg));
    const LaserFaults faults = faults_of(run);
    ASSERT_TRUE(faults.field_of_view_rad) << true_deg;
    EXPECT_NEAR(*faults.field_of_view_rad, mrpt::DEG2RAD(true_deg), 1e-9);
    EXPECT_EQ(faults.assumed_for_beams, 180U);
  }
}

TEST(LaserFaults, are_not_sought_where_the_user_states_options) {
  const auto wrong = shared_file("faults/wrong_fov.log.gz");
  const auto backwards = shared_file("faults/laser_backwards.db3.zstd");
  if (!wrong || !backwards) GTEST_SKIP() << kNeedsData;
  LogOptions options;
  options.field_of_view_rad = M_PI / 2;
  options.robot_T_laser = mrpt::math::TPose2D{0.25, 0, 0};
  EXPECT_FALSE(find_laser_faults(*wrong, options).field_of_view_rad);
  EXPECT_FALSE(find_laser_faults(*backwards, options).mount);
}

class SoundLog : public testing::TestWithParam<const char*> {};

TEST_P(SoundLog, has_no_laser_faults) {
  const auto log = shared_file(GetParam());
  if (!log) GTEST_SKIP() << kNeedsData;
  const LaserFaults faults = find_laser_faults(*log, {});
  EXPECT_FALSE(faults.field_of_view_rad);
  EXPECT_FALSE(faults.mount);
}

INSTANTIATE_TEST_SUITE_P(
    Logs, SoundLog,
    testing::Values("intel.clf.gz", "aces.clf.gz", "mit-csail.clf.gz", "mit-killian.clf.gz", "fr079.clf.gz",
                    "hospital/fr-hospital.clf.gz", "sparse/fhw.clf.gz", "sparse/acapulco.clf.gz",
                    "sparse/freiburg-campus.clf.gz", "bags/jan17_expt04.bag", "bags/jan17_expt10.bag",
                    "bags/guardian_controller_2.bag", "bags/jarvis_circular_path_fast.bag",
                    "bags/ccny_urg_demo.bag", "faults/collision26.log.gz", "faults/offset_+1.3s.db3.zstd",
                    "faults/beam_count_varies.db3.zstd", "faults/stall_a.clf.gz", "faults/ring_10125.clf.gz"),
    [](const auto& tested) {
      std::string name = tested.param;
      for (char& letter : name)
        if (std::isalnum(letter) == 0) letter = '_';
      return name;
    });

}  // namespace
}  // namespace psi_slam
