// SPDX-License-Identifier: BSD-3-Clause
#include "logs/doctor/beam_angle_study.h"

#include "log_files.h"
#include "simulated_run.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using mrpt::DEG2RAD;
using mrpt::math::TPose2D;

class BeamAngleStudyTest : public testing::Test {
 protected:
  /// Studies a simulated log with the true bearings `truth_rad`, read with the bearings `used_rad`. The laser
  /// looks straight ahead. With `with_heading`, the study gets the heading error that `used_rad` causes.
  BeamAngleStudy study(const std::vector<float>& truth_rad, const std::vector<float>& used_rad,
                       bool with_heading = true) {
    SimulatedRun run = round_trips(2);
    run.bearings_rad = truth_rad;
    const auto path = folder_.path() / "log";
    write_file(path, carmen_log(run));
    std::vector<FrameMark> marks;
    for (const TPose2D& pose : run.odometry) marks.push_back({static_cast<TimeUs>(marks.size()), pose});
    const BeamAngleEvidence evidence = choose_beam_angle_evidence(marks);
    ScanLibrary library;
    library.want(evidence.turning_pairs);
    for (const auto& turn : evidence.full_turns) library.want(turn);
    library.fetch(path, {});
    double shift_rad = 0;
    for (std::size_t i = 0; i < truth_rad.size(); ++i)
      shift_rad += static_cast<double>(truth_rad[i] - used_rad[i]) / static_cast<double>(truth_rad.size());
    return study_beam_angles(marks, evidence, library, used_rad, M_PI,
                             with_heading ? std::optional<double>(shift_rad) : std::nullopt);
  }

  static const BeamAngleFit& fit_of(const BeamAngleStudy& study, BeamAngles angles) {
    for (const BeamAngleFit& fit : study.fits)
      if (fit.angles == angles) return fit;
    throw std::out_of_range("no such fit");
  }

  TemporaryFolder folder_;
};

TEST_F(BeamAngleStudyTest, finds_the_convention_of_the_laser) {
  for (const BeamAngles truth :
       {BeamAngles::kLeftOpen, BeamAngles::kCentredHalfStep, BeamAngles::kSkipZero}) {
    const BeamAngleStudy result =
        study(make_bearings_rad(truth, 180, M_PI), make_bearings_rad(BeamAngles::kLeftOpen, 180, M_PI));
    EXPECT_EQ(result.best, truth) << name_of(truth);
    EXPECT_GT(result.pairs, 50U);
    EXPECT_GE(result.full_turns, 1U);
    EXPECT_FALSE(fit_of(result, truth).ruled_out_by_walls);
    const BeamAngles kinked = truth == BeamAngles::kSkipZero ? BeamAngles::kLeftOpen : BeamAngles::kSkipZero;
    EXPECT_TRUE(fit_of(result, kinked).ruled_out_by_walls);
    EXPECT_NEAR(fit_of(result, truth).laser_heading_rad, 0, DEG2RAD(0.01));
  }
}

TEST_F(BeamAngleStudyTest, measures_the_step_by_full_turns) {
  const auto whole_steps = make_bearings_rad(BeamAngles::kLeftOpen, 180, M_PI);
  const BeamAngleStudy whole = study(whole_steps, whole_steps);
  EXPECT_NEAR(fit_of(whole, BeamAngles::kLeftOpen).full_turn_error_rad, 0, DEG2RAD(0.3));
  EXPECT_NEAR(fit_of(whole, BeamAngles::kCentredStepInclusive).full_turn_error_rad, DEG2RAD(2.0),
              DEG2RAD(0.4));
  EXPECT_TRUE(fit_of(whole, BeamAngles::kCentredStepInclusive).ruled_out_by_turns);

  const auto wide_steps = make_bearings_rad(BeamAngles::kCentredStepInclusive, 180, M_PI);
  const BeamAngleStudy wide = study(wide_steps, whole_steps);
  EXPECT_EQ(wide.best, BeamAngles::kCentredStepInclusive);
  EXPECT_TRUE(fit_of(wide, BeamAngles::kLeftOpen).ruled_out_by_turns);
}

TEST_F(BeamAngleStudyTest, prefers_the_usual_convention_if_others_fit_equally) {
  const auto truth = make_bearings_rad(BeamAngles::kCentredHalfStep, 180, M_PI);
  const BeamAngleStudy result = study(truth, truth, false);
  EXPECT_FALSE(result.knows_heading);
  EXPECT_EQ(result.best, BeamAngles::kLeftOpen);
}

TEST_F(BeamAngleStudyTest, excludes_skip_zero_for_odd_numbers) {
  const auto truth = make_bearings_rad(BeamAngles::kCentredStepInclusive, 181, M_PI);
  const BeamAngleStudy result = study(truth, truth);
  EXPECT_EQ(result.fits.size(), 3U);
  EXPECT_EQ(result.best, BeamAngles::kCentredStepInclusive);
}

TEST_F(BeamAngleStudyTest, accepts_clockwise_readings) {
  auto truth = make_bearings_rad(BeamAngles::kSkipZero, 180, M_PI);
  for (float& bearing : truth) bearing = -bearing;
  EXPECT_EQ(study(truth, truth).best, BeamAngles::kSkipZero);
}

TEST_F(BeamAngleStudyTest, is_empty_without_turns) {
  const std::vector<FrameMark> marks(100);
  const BeamAngleStudy result =
      study_beam_angles(marks, choose_beam_angle_evidence(marks), {}, {0.F, 1.F}, 1, {});
  EXPECT_TRUE(result.fits.empty());
  EXPECT_EQ(result.best, BeamAngles::kAuto);
}

}  // namespace
}  // namespace psi_slam
