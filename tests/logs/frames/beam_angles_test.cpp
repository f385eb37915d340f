// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/laser_readings.h"

#include <gmock/gmock.h>
#include <mrpt/core/bits_math.h>

#include <vector>

#include "log_files.h"

namespace psi_slam {
namespace {

using mrpt::DEG2RAD;
using mrpt::RAD2DEG;

std::vector<double> degrees(BeamAngles angles, std::size_t beams, double field_of_view_deg) {
  std::vector<double> result;
  for (const float bearing : make_bearings_rad(angles, beams, DEG2RAD(field_of_view_deg)))
    result.push_back(RAD2DEG(static_cast<double>(bearing)));
  return result;
}

void expect_bearings(const std::vector<double>& found, double first, double before_middle, double middle,
                     double last) {
  const double tolerance_deg = 1e-5;
  EXPECT_NEAR(found.front(), first, tolerance_deg);
  EXPECT_NEAR(found[found.size() / 2 - 1], before_middle, tolerance_deg);
  EXPECT_NEAR(found[found.size() / 2], middle, tolerance_deg);
  EXPECT_NEAR(found.back(), last, tolerance_deg);
}

TEST(BeamAngles, convention_determines_the_bearings_of_180_beams) {
  const double step = 180.0 / 179.0;
  expect_bearings(degrees(BeamAngles::kCentredStepInclusive, 180, 180), -90, -step / 2, step / 2, 90);
  expect_bearings(degrees(BeamAngles::kCentredHalfStep, 180, 180), -89.5, -0.5, 0.5, 89.5);
  expect_bearings(degrees(BeamAngles::kLeftOpen, 180, 180), -90, -1, 0, 89);
  expect_bearings(degrees(BeamAngles::kSkipZero, 180, 180), -90, -1, 1, 90);
}

TEST(BeamAngles, odd_numbers_have_a_beam_straight_ahead) {
  expect_bearings(degrees(BeamAngles::kCentredStepInclusive, 361, 180), -90, -0.5, 0, 90);
  expect_bearings(degrees(BeamAngles::kCentredStepInclusive, 541, 270), -135, -0.5, 0, 135);
}

TEST(BeamAngles, usual_numbers_of_beams_have_usual_fields_of_view) {
  EXPECT_NEAR(*usual_field_of_view_rad(180), DEG2RAD(180.0), 1e-12);
  EXPECT_NEAR(*usual_field_of_view_rad(181), DEG2RAD(180.0), 1e-12);
  EXPECT_NEAR(*usual_field_of_view_rad(360), DEG2RAD(180.0), 1e-12);
  EXPECT_NEAR(*usual_field_of_view_rad(361), DEG2RAD(180.0), 1e-12);
  EXPECT_NEAR(*usual_field_of_view_rad(540), DEG2RAD(270.0), 1e-12);
  EXPECT_NEAR(*usual_field_of_view_rad(541), DEG2RAD(270.0), 1e-12);
  for (const std::size_t beams : {682, 683, 769}) {
    const auto bearings = degrees(BeamAngles::kAuto, beams, RAD2DEG(*usual_field_of_view_rad(beams)));
    EXPECT_NEAR(bearings[1] - bearings[0], 360.0 / 1024.0, 1e-4) << beams;
    EXPECT_NEAR(bearings.front(), -bearings.back(), 1e-4) << beams;
  }
  EXPECT_EQ(usual_field_of_view_rad(97), std::nullopt);
}

TEST(BeamAngles, usual_numbers_of_beams_have_whole_steps) {
  for (const auto& [beams, step_deg] : std::vector<std::pair<std::size_t, double>>{
           {180, 1.0}, {181, 1.0}, {360, 0.5}, {361, 0.5}, {540, 0.5}, {541, 0.5}}) {
    const auto bearings = degrees(BeamAngles::kAuto, beams, RAD2DEG(*usual_field_of_view_rad(beams)));
    EXPECT_NEAR(bearings[1] - bearings[0], step_deg, 1e-4) << beams;
  }
}

TEST(BeamAngles, skip_zero_rejects_odd_numbers) {
  EXPECT_EQ(sentence_of([] { make_bearings_rad(BeamAngles::kSkipZero, 181, 3.0); }),
            "log.beam_angles is skip_zero, which needs an even number of beams, but the scans have 181. "
            "Choose another convention");
}

TEST(BeamAngles, single_beam_points_straight_ahead) {
  for (const BeamAngles angles :
       {BeamAngles::kCentredStepInclusive, BeamAngles::kCentredHalfStep, BeamAngles::kLeftOpen})
    EXPECT_THAT(make_bearings_rad(angles, 1, 3.0), testing::ElementsAre(0.0F));
}

TEST(BeamAngles, have_the_names_of_settings_files) {
  std::vector<std::string_view> names;
  for (const BeamAngles angles : stated_beam_angles()) names.push_back(name_of(angles));
  EXPECT_THAT(names,
              testing::ElementsAre("centred_step_inclusive", "centred_half_step", "left_open", "skip_zero"));
  EXPECT_EQ(name_of(BeamAngles::kAuto), "auto");
}

}  // namespace
}  // namespace psi_slam
