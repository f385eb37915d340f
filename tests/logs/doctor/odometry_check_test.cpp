// SPDX-License-Identifier: BSD-3-Clause
#include "logs/doctor/odometry_check.h"

#include <functional>

#include "log_files.h"
#include "simulated_run.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

/// Checks a simulated run after `change` has modified each odometry pose. `options` can mirror the scans or
/// turn the laser.
class OdometryCheckTest : public testing::Test {
 protected:
  OdometryAgreement check(const std::function<void(TPose2D&)>& change, const LogOptions& options = {},
                          const SimulatedRun& run = round_trips(1)) {
    const auto path = folder_.path() / "log";
    write_file(path, carmen_log(run));
    std::vector<FrameMark> marks;
    for (TPose2D pose : run.odometry) {
      change(pose);
      pose.normalizePhi();
      marks.push_back({static_cast<TimeUs>(marks.size()) * 200'000, pose});
    }
    const auto tracks = tracks_from(frames_in_motion(marks, 60), marks.size());
    ScanLibrary library;
    for (const auto& track : tracks) library.want(track);
    library.fetch(path, options);
    return check_odometry(marks, tracks, library);
  }

  TemporaryFolder folder_;
};

TEST_F(OdometryCheckTest, agrees_with_sound_odometry) {
  const OdometryAgreement agreement = check([](TPose2D&) {});
  EXPECT_GT(agreement.tracks, 50U);
  EXPECT_NEAR(agreement.length_ratio, 1, 0.05);
  EXPECT_EQ(agreement.heading, HeadingRelation::kAgrees);
  EXPECT_GT(agreement.heading_share, 0.9);
  EXPECT_NEAR(agreement.direction_offset_rad, 0, 0.05);
  EXPECT_GT(agreement.direction_concentration, 0.9);
  EXPECT_LT(agreement.odometry_slip_rad, 0.1);
}

TEST_F(OdometryCheckTest, measures_the_unit_of_length) {
  for (const double factor : {1000.0, 100.0, 0.01, 3.281}) {
    const OdometryAgreement agreement = check([&](TPose2D& pose) {
      pose.x *= factor;
      pose.y *= factor;
    });
    EXPECT_NEAR(agreement.length_ratio / factor, 1, 0.05) << factor;
    EXPECT_EQ(agreement.heading, HeadingRelation::kAgrees) << factor;
  }
}

TEST_F(OdometryCheckTest, detects_degrees) {
  EXPECT_EQ(check([](TPose2D& pose) { pose.phi *= 180 / M_PI; }).heading, HeadingRelation::kDegrees);
  EXPECT_EQ(check([](TPose2D& pose) { pose.phi *= -180 / M_PI; }).heading, HeadingRelation::kOppositeDegrees);
}

TEST_F(OdometryCheckTest, distinguishes_a_mirrored_scan_from_clockwise_headings) {
  LogOptions mirrored;
  mirrored.mirrored = true;
  const OdometryAgreement scan = check([](TPose2D&) {}, mirrored);
  EXPECT_EQ(scan.heading, HeadingRelation::kOpposite);
  EXPECT_LT(scan.odometry_slip_rad, 0.1);
  const OdometryAgreement heading = check([](TPose2D& pose) {
    // Turns the path by 0.7 rad. Along the axes, a negated right angle would look like reversing.
    pose = TPose2D{0, 0, 0.7} + pose;
    pose.phi = -pose.phi;
  });
  EXPECT_EQ(heading.heading, HeadingRelation::kOpposite);
  EXPECT_GT(heading.odometry_slip_rad, 0.4);
}

TEST_F(OdometryCheckTest, detects_constant_and_unrelated_headings) {
  EXPECT_EQ(check([](TPose2D& pose) { pose.phi = 1; }).heading, HeadingRelation::kNone);
  EXPECT_EQ(check([](TPose2D& pose) { pose.phi = 1e3 * std::sin(1e4 * pose.x + 77 * pose.phi); }).heading,
            HeadingRelation::kUnrelated);
}

TEST_F(OdometryCheckTest, headings_that_change_elsewhere_are_not_constant) {
  const SimulatedRun run = round_trips(1);
  std::size_t frame = 0;
  const OdometryAgreement agreement =
      check([&](TPose2D& pose) { pose.phi = frame++ < 500 ? 1 : 2; }, {}, run);
  EXPECT_EQ(agreement.heading, HeadingRelation::kUnrelated);
}

TEST_F(OdometryCheckTest, finds_clocks_that_differ) {
  const SimulatedRun run = round_trips(2);
  const auto path = folder_.path() / "log";
  write_file(path, carmen_log(run));
  for (const int periods : {-40, -10, 7, 150}) {
    std::vector<FrameMark> marks;  // odometry of a clock that is ahead by this number of periods
    const int last = static_cast<int>(run.odometry.size()) - 1;
    for (int i = 0; i <= last; ++i)
      marks.push_back(
          {200'000 * i, run.odometry[static_cast<std::size_t>(std::clamp(i + periods, 0, last))]});
    const auto tracks = tracks_from(frames_in_motion(marks, 60), marks.size());
    ScanLibrary library;
    for (const auto& track : tracks) library.want(track);
    library.fetch(path, {});
    const OdometryAgreement agreement = check_odometry_and_delay(marks, tracks, library);
    EXPECT_FALSE(is_sound(agreement));
    ASSERT_TRUE(agreement.clock_offset) << periods;
    EXPECT_NEAR(agreement.clock_offset->delay_s, 0.2 * periods, 0.05);
    EXPECT_LT(agreement.clock_offset->deviation_s, 0.03);
  }
}

TEST_F(OdometryCheckTest, odometry_of_another_robot_is_unrelated) {
  SimulatedRun run = round_trips(2);
  const SimulatedRun other = simulated_run({{0.1, 2, 80},
                                            {0, -5, 60},
                                            {0.06, -1.5, 200},
                                            {0.1, 4, 60},
                                            {0, 0, 100},
                                            {0.08, 0.7, 300},
                                            {0, 3, 40},
                                            {0.1, -1, 192}});
  std::size_t frame = 0;
  const OdometryAgreement agreement = check(
      [&](TPose2D& pose) { pose = other.odometry[std::min(frame++, other.odometry.size() - 1)]; }, {}, run);
  EXPECT_EQ(agreement.heading, HeadingRelation::kUnrelated);
  EXPECT_FALSE(agreement.clock_offset);
}

TEST_F(OdometryCheckTest, measures_the_heading_of_the_laser) {
  for (const double yaw_rad : {M_PI / 2, M_PI - 0.01, -1.0}) {
    LogOptions options;
    options.robot_T_laser = TPose2D{0, 0, yaw_rad};
    const OdometryAgreement agreement = check([](TPose2D&) {}, options);
    EXPECT_NEAR(mrpt::math::wrapToPi(agreement.direction_offset_rad - yaw_rad), 0, 0.05);
    EXPECT_GT(agreement.direction_concentration, 0.9);
  }
}

TEST_F(OdometryCheckTest, follows_the_scans_if_odometry_is_constant) {
  const OdometryAgreement agreement = check([](TPose2D& pose) { pose = {0, 0, 0}; });
  EXPECT_GT(agreement.scan_path_m, 5);
  EXPECT_EQ(agreement.odometry_path_m, 0);
}

TEST_F(OdometryCheckTest, does_not_compare_lengths_in_a_bare_corridor) {
  SimulatedRun run = simulated_run({{0.1, 0, 400}}, {5, 1.2, 0});
  run.walls.clear();
  add_box(run.walls, 0, 0, 60, 2.4);
  run.put_into = [](std::vector<float>& ranges_m, std::size_t) {
    for (float& range_m : ranges_m) range_m = range_m > 8 ? 60.0F : range_m;  // the ends are out of range
  };
  run.noise_m = 0.02;
  const OdometryAgreement agreement = check([](TPose2D&) {}, {}, run);
  EXPECT_GT(agreement.tracks, 20U);
  EXPECT_EQ(agreement.length_ratio, 0) << agreement.length_samples;
}

TEST(OdometryCheck, is_unknown_for_an_empty_log) {
  const OdometryAgreement agreement = check_odometry({}, {}, {});
  EXPECT_EQ(agreement.heading, HeadingRelation::kUnknown);
  EXPECT_EQ(agreement.length_ratio, 0);
}

}  // namespace
}  // namespace psi_slam
