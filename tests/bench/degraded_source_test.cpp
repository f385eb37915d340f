// SPDX-License-Identifier: BSD-3-Clause
#include "robustness/robustness_benchmark.h"

#include <gtest/gtest.h>
#include <mrpt/math/wrap2pi.h>

#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/random_draws.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr std::size_t kStepsAhead = 30;
constexpr std::size_t kStepsInAll = 40;

/// Motion from pose i - 1 to pose i. Motions of 3 m straight ahead and 3 rad on the spot alternate.
TPose2D step(std::size_t i) {
  return i % kStepsInAll < kStepsAhead ? TPose2D(0.1, 0, 0) : TPose2D(0, 0, 0.3);
}

class HandMadeSource : public FrameSource {
 public:
  explicit HandMadeSource(std::size_t frames) : frames_(frames) {}
  std::optional<Frame> next() override {
    if (index_ == frames_) return std::nullopt;
    if (index_ > 0) odom_T_robot_ = odom_T_robot_ + step(index_);
    Frame frame;
    frame.index = index_;
    frame.time_us = static_cast<TimeUs>(index_) * 100'000;
    frame.odom_T_robot = odom_T_robot_;
    frame.scan.bearings_rad = bearings_;
    frame.scan.ranges_m = {1, 2, 3, 4, 5};
    ++index_;
    return frame;
  }
  double progress() const override { return static_cast<double>(index_) / static_cast<double>(frames_); }

 private:
  std::size_t frames_;
  std::size_t index_ = 0;
  TPose2D odom_T_robot_{5, 6, 0.5};
  BeamBearings bearings_ = std::make_shared<const std::vector<float>>(
      std::vector<float>{-1.5F, -static_cast<float>(M_PI / 4), 0.0F, static_cast<float>(M_PI / 4), 1.5F});
};

std::vector<Frame> frames_of(const DegradationOptions& options, std::size_t frames) {
  DegradedSource source(std::make_unique<HandMadeSource>(frames), options);
  std::vector<Frame> result;
  while (auto frame = source.next()) result.push_back(std::move(*frame));
  EXPECT_EQ(source.progress(), 1);
  return result;
}

std::vector<TPose2D> odometry_of(const std::vector<Frame>& frames) {
  std::vector<TPose2D> poses;
  for (const Frame& frame : frames) poses.push_back(frame.odom_T_robot);
  return poses;
}

TEST(DegradedSource, leaves_a_log_unchanged_by_default) {
  const std::vector<Frame> frames = frames_of({}, 20);
  HandMadeSource source(20);
  ASSERT_EQ(frames.size(), 20U);
  for (const Frame& frame : frames) {
    const Frame same = source.next().value();
    EXPECT_EQ(frame.index, same.index);
    EXPECT_EQ(frame.odom_T_robot, same.odom_T_robot);
    EXPECT_EQ(frame.scan.ranges_m, same.scan.ranges_m);
    EXPECT_TRUE(frame.has_odometry);
  }
}

TEST(DegradedSource, keeps_every_nth_scan_with_new_indices) {
  DegradationOptions options;
  options.keep_every_nth = 3;
  const std::vector<Frame> frames = frames_of(options, 8);
  ASSERT_EQ(frames.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(frames[i].index, i);
    EXPECT_EQ(frames[i].time_us, static_cast<TimeUs>(i) * 300'000);
  }
}

TEST(DegradedSource, beams_outside_the_field_of_view_have_no_return) {
  DegradationOptions options;
  options.field_of_view_rad = M_PI / 2;
  const std::vector<float> ranges = frames_of(options, 1).front().scan.ranges_m;
  ASSERT_EQ(ranges.size(), 5U);
  EXPECT_TRUE(std::isnan(ranges[0]) && std::isnan(ranges[4]));
  EXPECT_EQ(ranges[1], 2) << "the outermost beam inside";
  EXPECT_EQ(ranges[2], 3);
  EXPECT_EQ(ranges[3], 4);
}

TEST(DegradedSource, marks_frames_without_odometry) {
  DegradationOptions options;
  options.no_odometry = true;
  options.odometry_noise_scale = 4;
  for (const Frame& frame : frames_of(options, 5)) {
    EXPECT_FALSE(frame.has_odometry);
    EXPECT_EQ(frame.odom_T_robot, TPose2D());
  }
}

/// Root mean square errors of odometry over several stretches of the path.
struct StretchErrors {
  double way_m = 0;
  double turn_rad = 0;
};

/// Errors over stretches of `steps` steps, which start at pose `first` and every kStepsInAll poses after it.
StretchErrors errors_over(const std::vector<TPose2D>& odometry, const std::vector<TPose2D>& truth,
                          std::size_t first, std::size_t steps) {
  StretchErrors squares;
  double stretches = 0;
  for (std::size_t begin = first; begin + steps < truth.size(); begin += kStepsInAll) {
    const std::size_t end = begin + steps;
    const TPose2D off = (odometry[end] - odometry[begin]) - (truth[end] - truth[begin]);
    squares.way_m += off.x * off.x + off.y * off.y;
    squares.turn_rad += std::pow(mrpt::math::wrapToPi(off.phi), 2);
    ++stretches;
  }
  return {std::sqrt(squares.way_m / stretches), std::sqrt(squares.turn_rad / stretches)};
}

/// Draws true poses of a robot whose odometry has this noise.
std::vector<TPose2D> truth_of(const std::vector<TPose2D>& odometry, const OdometryNoise& noise) {
  std::vector<TPose2D> truth{odometry.front()};
  RandomDraws draws(5, "truth", 0);
  for (std::size_t i = 1; i < odometry.size(); ++i) {
    const TPose2D moved = step(i);
    const double root_m = std::sqrt(std::hypot(moved.x, moved.y));
    const double sigma_rad =
        std::hypot(noise.sigma_rad_per_root_m * root_m, noise.sigma_rad_per_root_rad * std::sqrt(moved.phi));
    const double sigma_m = noise.sigma_m_per_root_m * root_m;
    truth.push_back(truth.back() + TPose2D(moved.x + sigma_m * draws.normal(), sigma_m * draws.normal(),
                                           moved.phi + sigma_rad * draws.normal()));
  }
  return truth;
}

TEST(DegradedSource, multiplies_the_error_of_odometry) {
  constexpr std::size_t kFrames = 60'000;
  const std::vector<TPose2D> odometry = odometry_of(frames_of({}, kFrames));
  const std::vector<TPose2D> truth = truth_of(odometry, {0.01, 0.02, 0.03});
  DegradationOptions options;
  options.natural_noise = measure_odometry_noise(odometry, truth);
  // Step i leads to pose i. The stretches are straight ahead, rotations only, and both. With both, errors of
  // the heading also affect positions.
  constexpr std::size_t kLast = kStepsInAll - 1;
  for (const auto& [first, steps] :
       {std::pair(kLast, kStepsAhead), std::pair(kStepsAhead - 1, std::size_t{10}),
        std::pair(std::size_t{19}, kStepsInAll)}) {
    const StretchErrors natural = errors_over(odometry, truth, first, steps);
    for (const double scale : {1.0, 2.0, 4.0}) {
      SCOPED_TRACE("steps " + std::to_string(first) + " and on, x " + std::to_string(scale));
      options.odometry_noise_scale = scale;
      const StretchErrors errors = errors_over(odometry_of(frames_of(options, kFrames)), truth, first, steps);
      EXPECT_NEAR(errors.way_m, scale * natural.way_m, 0.1 * scale * natural.way_m + 1e-9);
      EXPECT_NEAR(errors.turn_rad, scale * natural.turn_rad, 0.1 * scale * natural.turn_rad);
    }
  }
}

TEST(DegradedSource, the_noise_does_not_depend_on_the_number_of_kept_scans) {
  DegradationOptions options;
  options.odometry_noise_scale = 2;
  options.natural_noise = {0.1, 0.1, 0.1};
  const std::vector<TPose2D> all = odometry_of(frames_of(options, 9));
  options.keep_every_nth = 4;
  const std::vector<TPose2D> some = odometry_of(frames_of(options, 9));
  EXPECT_EQ(some, (std::vector<TPose2D>{all[0], all[4], all[8]}));
  options.seed = 2;
  EXPECT_FALSE(odometry_of(frames_of(options, 9))[2] == all[8]);
}

TEST(DegradedSource, refuses_options_that_leave_nothing) {
  DegradationOptions options;
  options.keep_every_nth = 0;
  EXPECT_THROW(frames_of(options, 1), std::invalid_argument);
  options.keep_every_nth = 1;
  options.field_of_view_rad = 0;
  EXPECT_THROW(frames_of(options, 1), std::invalid_argument);
}

}  // namespace
}  // namespace psi_slam
