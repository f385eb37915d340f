// SPDX-License-Identifier: BSD-3-Clause
#include "logs/doctor/pair_alignment.h"

#include "log_files.h"
#include "simulated_run.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using mrpt::DEG2RAD;
using mrpt::math::TPose2D;

class OdometryFaultsTest : public testing::Test {
 protected:
  void take(const SimulatedRun& run) {
    path_ = folder_.path() / "log";
    write_file(path_, carmen_log(run));
    marks_.clear();
    for (const TPose2D& pose : run.odometry)
      marks_.push_back({static_cast<TimeUs>(marks_.size()) * 200'000, pose});
  }

  ScanLibrary library_of(const std::vector<FramePair>& pairs) {
    ScanLibrary library;
    library.want(pairs);
    library.fetch(path_, {});
    return library;
  }

  TemporaryFolder folder_;
  std::filesystem::path path_;
  std::vector<FrameMark> marks_;
};

/// Moves the odometry of frame `from` and all later frames by the motion `by`, in the robot's frame.
void jump(SimulatedRun& run, std::size_t from, const TPose2D& by) {
  const TPose2D old = run.odometry[from];
  const TPose2D moved = old + by;
  for (std::size_t i = from; i < run.odometry.size(); ++i) run.odometry[i] = moved + (run.odometry[i] - old);
}

TEST_F(OdometryFaultsTest, include_jumps_that_the_scans_do_not_confirm) {
  SimulatedRun run = simulated_run({{0.08, 0, 60}, {0, 3, 30}, {0.08, 0, 60}});
  take(run);
  EXPECT_TRUE(suspected_jumps(marks_, 0.2, 10).empty());
  jump(run, 20, {0.9, 0.3, 0});
  jump(run, 40, {0, 0, DEG2RAD(-80.0)});
  take(run);
  const auto suspects = suspected_jumps(marks_, 0.2, 10);
  ASSERT_EQ(suspects.size(), 2U);
  const OdometryJumps jumps = confirm_jumps(marks_, suspects, library_of(suspects));
  ASSERT_EQ(jumps.pairs.size(), 2U);
  EXPECT_NEAR(jumps.largest_m, 1.0, 0.1);
  EXPECT_NEAR(jumps.largest_turn_rad, DEG2RAD(80.0), DEG2RAD(1.0));
  EXPECT_EQ(suspected_jumps(marks_, 0.2, 1).size(), 1U);
}

TEST_F(OdometryFaultsTest, exclude_real_motion) {
  SimulatedRun run = simulated_run({{0.08, 0, 30}});
  run.truth.push_back(run.truth.back() + TPose2D{0.6, 0, 0.1});  // large step after lost messages
  run.odometry.push_back(run.odometry.back() + TPose2D{0.62, 0, 0.1});
  take(run);
  const auto suspects = suspected_jumps(marks_, 0.2, 10);
  ASSERT_EQ(suspects.size(), 1U);
  EXPECT_TRUE(confirm_jumps(marks_, suspects, library_of(suspects)).pairs.empty());
}

TEST_F(OdometryFaultsTest, include_odometry_that_a_mapper_has_corrected) {
  SimulatedRun run = round_trips(2);
  take(run);
  auto pairs = revisiting_pairs(marks_, 0.5, 0.5, 20, 100);
  const RevisitAgreement raw = check_revisits(marks_, pairs, library_of(pairs));
  EXPECT_LT(raw.agreeing * 4, raw.revisits + 4) << "raw odometry drifts";
  run.odometry = run.truth;
  take(run);
  pairs = revisiting_pairs(marks_, 0.5, 0.5, 20, 100);
  const RevisitAgreement corrected = check_revisits(marks_, pairs, library_of(pairs));
  EXPECT_GE(corrected.revisits, 20U);
  EXPECT_GT(corrected.agreeing * 10, corrected.revisits * 9);
  EXPECT_LT(corrected.median_offset_m, 0.01);
}

}  // namespace
}  // namespace psi_slam
