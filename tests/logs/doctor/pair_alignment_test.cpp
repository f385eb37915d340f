// SPDX-License-Identifier: BSD-3-Clause
#include "logs/doctor/pair_alignment.h"

#include "aligned_run.h"
#include "log_files.h"
#include "simulated_run.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using mrpt::DEG2RAD;
using mrpt::math::TPose2D;

class PairAlignmentTest : public testing::Test {
 protected:
  std::vector<AlignedPair> aligned(const SimulatedRun& run) {
    const auto path = folder_.path() / "log";
    write_file(path, carmen_log(run));
    std::vector<FrameMark> marks;
    for (const TPose2D& pose : run.odometry) marks.push_back({static_cast<TimeUs>(marks.size()), pose});
    const auto pairs = pairs_by_motion(marks, 0.25, DEG2RAD(12.0), 5000);
    library_.want(pairs);
    library_.fetch(path, {});
    return align_pairs(marks, pairs, library_);
  }

  TemporaryFolder folder_;
  ScanLibrary library_;
};

/// Simulates wheel encoders without a sign: reversing counts as driving forwards.
void lose_the_sign_of_reversing(SimulatedRun& run) {
  std::vector<TPose2D> odometry{run.odometry.front()};
  for (std::size_t i = 1; i < run.odometry.size(); ++i) {
    TPose2D step = run.odometry[i] - run.odometry[i - 1];
    step.x = std::abs(step.x);
    odometry.push_back(odometry.back() + step);
  }
  run.odometry = odometry;
}

TEST_F(PairAlignmentTest, aligns_pairs_that_odometry_puts_near) {
  const auto pairs = aligned(round_trips(1));
  ASSERT_GT(pairs.size(), 100U);
  std::size_t reliable = 0;
  for (const AlignedPair& pair : pairs) {
    if (!pair.by_scans.is_reliable()) continue;
    ++reliable;
    const TPose2D off = pair.by_scans.reference_T_scan - pair.by_odometry;
    EXPECT_LT(off.norm(), 0.06);
  }
  EXPECT_GT(reliable, pairs.size() * 9 / 10);
}

TEST_F(PairAlignmentTest, finds_reversing_that_odometry_counts_forwards) {
  const std::vector<RunPart> parts{{0.08, 0, 60}, {-0.08, 0, 40}, {0.08, 0, 20}, {0, 3, 30}, {-0.05, 0, 24}};
  SimulatedRun run = simulated_run(parts);
  EXPECT_TRUE(find_lost_reversals(aligned(run), library_).pairs.empty())
      << "reversing with the right sign is sound";
  lose_the_sign_of_reversing(run);
  library_ = ScanLibrary();
  const LostReversals reversals = find_lost_reversals(aligned(run), library_);
  EXPECT_NEAR(reversals.reversed_m, 40 * 0.08 + 24 * 0.05, 0.9);
  ASSERT_GE(reversals.pairs.size(), 12U);
  EXPECT_GE(reversals.pairs.front().first, 56U);
  EXPECT_LE(reversals.pairs.front().first, 66U);
}

TEST_F(PairAlignmentTest, finds_the_mount_of_the_laser) {
  SimulatedRun run = round_trips(2);
  run.robot_T_laser = {0.25, -0.1, DEG2RAD(4.0)};
  const auto mount = estimate_laser_mount(aligned(run), {0, 0, 0});
  ASSERT_TRUE(mount);
  EXPECT_NEAR(mount->robot_T_laser.x, 0.25, 0.02);
  EXPECT_NEAR(mount->robot_T_laser.y, -0.1, 0.02);
  EXPECT_NEAR(mount->robot_T_laser.phi, DEG2RAD(4.0), DEG2RAD(0.6));
  EXPECT_NEAR(mount->odometry_scale, 1, 0.01);
  EXPECT_LT(mount->deviation_m, 0.02);
  EXPECT_LT(mount->deviation_rad, DEG2RAD(0.6));
}

TEST_F(PairAlignmentTest, measures_the_scale_of_odometry) {
  SimulatedRun run = round_trips(1);
  run.robot_T_laser = {0.5, 0, 0};
  for (TPose2D& pose : run.odometry) {
    pose.x *= 1.05;
    pose.y *= 1.05;
  }
  const auto mount = estimate_laser_mount(aligned(run), {0, 0, 0});
  ASSERT_TRUE(mount);
  EXPECT_NEAR(mount->odometry_scale, 1.05, 0.01);
  EXPECT_NEAR(mount->robot_T_laser.x, 0.5, 0.015) << "in metres, not in those of odometry";
}

TEST_F(PairAlignmentTest, straight_motion_shows_the_scale_but_not_the_position_of_the_laser) {
  SimulatedRun run = simulated_run({{0.08, 0, 115}, {-0.08, 0, 115}});
  const auto mount = estimate_laser_mount(aligned(run), {0.2, 0, 0});
  ASSERT_TRUE(mount);
  EXPECT_GT(mount->deviation_m, 0.05);
  EXPECT_LT(mount->scale_deviation, 0.01);
  EXPECT_NEAR(mount->odometry_scale, 1, 4 * mount->scale_deviation);
}

TEST_F(PairAlignmentTest, finds_no_mount_in_a_short_log) {
  EXPECT_FALSE(estimate_laser_mount(aligned(simulated_run({{0.08, 0, 80}})), {0, 0, 0}));
}

// The errors of the estimates, divided by their standard deviations, have a mean square of about 1.
TEST(LaserMountEstimate, errors_are_as_large_as_the_standard_deviations) {
  constexpr unsigned kRuns = 8;
  double scale_squares = 0;
  double mount_squares = 0;
  double heading_squares = 0;
  for (unsigned seed = 1; seed <= kRuns; ++seed) {
    SimulatedRun run = round_trips(1, seed);
    run.seed = seed;
    run.robot_T_laser = {0.2, 0.05, DEG2RAD(2.0)};
    const auto mount = estimate_laser_mount(aligned_run(run).pairs, run.robot_T_laser);
    ASSERT_TRUE(mount);
    const TPose2D off = mount->robot_T_laser - run.robot_T_laser;
    EXPECT_LT(mount->scale_deviation, 0.005);
    scale_squares += std::pow((mount->odometry_scale - 1) / mount->scale_deviation, 2);
    mount_squares += std::pow(off.norm() / mount->deviation_m, 2) / 2;
    heading_squares += std::pow(off.phi / mount->deviation_rad, 2);
  }
  for (const double squares : {scale_squares, mount_squares, heading_squares}) {
    EXPECT_GT(std::sqrt(squares / kRuns), 0.5);
    EXPECT_LT(std::sqrt(squares / kRuns), 1.7);
  }
}

}  // namespace
}  // namespace psi_slam
