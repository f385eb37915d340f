// SPDX-License-Identifier: BSD-3-Clause
#include "logs/doctor/field_of_view_study.h"

#include <gtest/gtest.h>

#include "log_files.h"
#include "simulated_run.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

/// Studies a run whose laser really has `true_deg`, by a log that is read with `stated_deg`. `gain`: turns of
/// odometry divided by true turns.
FieldOfViewStudy study_of(double true_deg, double stated_deg, double gain = 1) {
  SimulatedRun run = round_trips(1);
  run.bearings_rad = make_bearings_rad(BeamAngles::kLeftOpen, 180, mrpt::DEG2RAD(true_deg));
  std::vector<FrameMark> marks;
  for (std::size_t i = 0; i < run.odometry.size(); ++i) {
    mrpt::math::TPose2D pose = run.odometry[i];
    pose.phi = mrpt::math::wrapToPi(gain * pose.phi);
    marks.push_back({200'000 * static_cast<TimeUs>(i), pose});
  }
  const TemporaryFolder folder;
  write_file(folder.path() / "log", carmen_log(run));
  LogOptions options;
  options.field_of_view_rad = mrpt::DEG2RAD(stated_deg);
  const FieldOfViewEvidence evidence = choose_field_of_view_evidence(marks);
  ScanLibrary library;
  library.want(evidence.turning_pairs);
  library.want(evidence.straight_pairs);
  library.fetch(folder.path() / "log", options);
  return study_field_of_view(marks, evidence, library);
}

TEST(FieldOfViewStudy, finds_a_field_of_view_that_is_wrong_by_a_factor_of_two) {
  for (const auto& [true_deg, stated_deg] :
       {std::pair(180.0, 90.0), std::pair(90.0, 180.0), std::pair(360.0, 180.0), std::pair(180.0, 360.0)}) {
    const FieldOfViewStudy study = study_of(true_deg, stated_deg);
    EXPECT_TRUE(study.finds_fault()) << true_deg << ", stated " << stated_deg;
    EXPECT_NEAR(study.fits[study.best].field_of_view_rad, mrpt::DEG2RAD(true_deg), 1e-9);
    EXPECT_NEAR(study.fits.front().field_of_view_rad, mrpt::DEG2RAD(stated_deg), 1e-9);
  }
}

TEST(FieldOfViewStudy, trusts_a_log_that_is_right) {
  for (const double true_deg : {90.0, 180.0, 270.0, 360.0})
    EXPECT_FALSE(study_of(true_deg, true_deg).finds_fault()) << true_deg;
}

TEST(FieldOfViewStudy, does_not_blame_the_laser_for_turns_of_odometry) {
  for (const double gain : {-1.0, 0.5, 2.0, 1.2})
    EXPECT_FALSE(study_of(180, 180, gain).finds_fault()) << gain;
}

}  // namespace
}  // namespace psi_slam
