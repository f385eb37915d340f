// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/loop_verification.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "two_rounds.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using Reason = LoopRejection::Reason;

void judge(LoopRecord& loop, const LoopVerificationOptions& options = {}) {
  verify(loop, *two_rounds().keyframes.nodes[loop.node].points, two_rounds().keyframes, options);
}

constexpr double kNarrow_m = 0.5;
constexpr double kWide_m = 3.0;

void expect_rejected(const LoopRecord& loop, LoopRejection::Reason reason) {
  EXPECT_EQ(loop.state, LoopState::kRejected);
  ASSERT_TRUE(loop.rejection.has_value());
  EXPECT_EQ(loop.rejection->reason, reason) << text_of(loop.rejection);
}

TEST(LoopVerification, a_right_match_in_a_narrow_window_is_accepted) {
  LoopRecord loop = two_rounds().loop(kNarrow_m);
  judge(loop);
  EXPECT_EQ(loop.state, LoopState::kAccepted) << text_of(loop.rejection);
  EXPECT_FALSE(loop.rejection.has_value());
  EXPECT_GT(loop.observed_share, 0.9);
  EXPECT_GT(loop.neighbours_agree, 0.9);
  EXPECT_GT(loop.reverse_agree, 0.9);
}

TEST(LoopVerification, a_right_match_in_a_wide_window_waits_for_others) {
  LoopRecord loop = two_rounds().loop(kWide_m);
  judge(loop);
  EXPECT_EQ(loop.state, LoopState::kCandidate);
  EXPECT_FALSE(loop.rejection.has_value()) << text_of(loop.rejection);
}

TEST(LoopVerification, a_match_one_metre_off_is_rejected_with_a_reason) {
  for (const double half_width_m : {kNarrow_m, kWide_m})
    for (const TPose2D& off : {TPose2D(1, 0, 0), TPose2D(-1, 0, 0), TPose2D(0, 1, 0), TPose2D(0, -1, 0),
                               TPose2D(0, 0, M_PI / 4), TPose2D(0, 0, M_PI)}) {
      LoopRecord loop = two_rounds().loop(half_width_m, off);
      judge(loop);
      EXPECT_EQ(loop.state, LoopState::kRejected) << off.asString();
      EXPECT_TRUE(loop.rejection.has_value()) << off.asString();
      EXPECT_LT(loop.neighbours_agree, 0.75) << off.asString();
    }
}

TEST(LoopVerification, of_neighbours_close_to_one_another_only_the_nearest_counts) {
  KeyframeStore keyframes = two_rounds().keyframes;
  const auto agreement = [&] {
    LoopRecord loop = two_rounds().loop(kNarrow_m);
    verify(loop, *keyframes.nodes[loop.node].points, keyframes, {});
    return loop.neighbours_agree;
  };
  const double all = agreement();
  const std::size_t nearest = two_rounds().node - 1;
  ASSERT_LT(
      travel_and_turn_m(keyframes.nodes[nearest].local_T_robot, keyframes.nodes[nearest - 1].local_T_robot),
      0.3);
  const auto nonsense = std::make_shared<ScanPoints>();
  nonsense->points.assign(100, {0.3F, 0.3F});  // in free space
  keyframes.nodes[nearest - 1].points = nonsense;
  EXPECT_EQ(agreement(), all);
  keyframes.nodes[nearest].points = nonsense;
  EXPECT_LT(agreement(), all);
}

TEST(LoopVerification, the_nearest_neighbours_count_however_small_the_neighbourhood) {
  LoopVerificationOptions options;
  options.neighbourhood_m = 0.2;
  LoopRecord loop = two_rounds().loop(kNarrow_m);
  judge(loop, options);
  EXPECT_GT(loop.neighbours_agree, 0.9);
}

TEST(LoopVerification, a_wrong_match_is_rejected_by_the_reverse_test_too) {
  LoopVerificationOptions options;
  options.min_observed_share = 0;
  options.min_neighbours_agree = 0;
  for (const TPose2D& off : {TPose2D(1, 0, 0), TPose2D(0, 0, M_PI / 4)}) {
    LoopRecord loop = two_rounds().loop(kNarrow_m, off);
    judge(loop, options);
    expect_rejected(loop, Reason::kReverseDisagrees);
    EXPECT_LT(loop.reverse_agree, 0.75) << off.asString();
  }
}

TEST(LoopVerification, an_ambiguous_match_is_rejected_in_narrow_windows_only) {
  LoopRecord narrow = two_rounds().loop(kNarrow_m);
  narrow.ambiguity = 0.95;
  judge(narrow);
  expect_rejected(narrow, Reason::kAmbiguous);
  LoopRecord wide = two_rounds().loop(kWide_m);
  wide.ambiguity = 0.95;
  judge(wide);
  EXPECT_EQ(wide.state, LoopState::kCandidate) << text_of(wide.rejection);
}

TEST(LoopVerification, a_match_far_from_its_prediction_must_be_less_ambiguous) {
  LoopRecord loop = two_rounds().loop(kNarrow_m);
  loop.prior = 0.15;
  loop.ambiguity = 0.3;
  judge(loop);
  EXPECT_EQ(loop.state, LoopState::kAccepted) << text_of(loop.rejection);
  loop.ambiguity = 0.4;
  judge(loop);
  expect_rejected(loop, Reason::kAmbiguous);
  EXPECT_NEAR(loop.rejection->value, 0.91, 1e-9);
}

TEST(LoopVerification, the_response_needed_depends_on_the_window) {
  const LoopVerificationOptions options;
  EXPECT_FALSE(is_wide({options.wide_window_m, options.wide_window_m, 9}, options));
  EXPECT_TRUE(is_wide({0.1, options.wide_window_m + 0.01, 0.1}, options));
  EXPECT_TRUE(is_wide({options.wide_window_m + 0.01, 0.1, 0.1}, options));
  EXPECT_EQ(min_response({kNarrow_m, kNarrow_m, 0.1}, options), options.min_response);
  EXPECT_EQ(min_response({kWide_m, kWide_m, 0.1}, options), options.min_context_response);

  for (const double half_width_m : {kNarrow_m, kWide_m}) {
    LoopRecord loop = two_rounds().loop(half_width_m);
    const double needed = min_response(loop.window, options);
    loop.response = needed - 0.01;
    judge(loop);
    expect_rejected(loop, Reason::kLowResponse);
    loop.response = needed;
    judge(loop);
    EXPECT_NE(loop.state, LoopState::kRejected) << text_of(loop.rejection);
  }
}

TEST(LoopVerification, searches_report_low_responses_in_narrow_windows_or_by_hand) {
  LoopVerificationOptions options;
  options.min_response = 0.5;
  options.min_context_response = 0.35;
  const SearchExtent narrow{kNarrow_m, kNarrow_m, 0.1};
  const SearchExtent wide{kWide_m, kWide_m, 0.1};
  EXPECT_DOUBLE_EQ(least_reported_response(narrow, options), 0.4);
  EXPECT_DOUBLE_EQ(least_reported_response(wide, options), 0.35);
  EXPECT_DOUBLE_EQ(least_response_by_hand(narrow, options), 0.4);
  EXPECT_DOUBLE_EQ(least_response_by_hand(wide, options), 0.28);
}

TEST(LoopVerification, a_position_known_in_one_direction_only_is_rejected) {
  LoopRecord loop = two_rounds().loop(kNarrow_m);
  // Standard deviations of 0.4 m along a corridor at 45 degrees and of 0.01 m across it. Along x and y, they
  // are 0.28 m.
  loop.covariance(0, 0) = loop.covariance(1, 1) = 0.5 * (0.16 + 0.0001);
  loop.covariance(0, 1) = loop.covariance(1, 0) = 0.5 * (0.16 - 0.0001);
  judge(loop);
  expect_rejected(loop, Reason::kUncertainPosition);
  EXPECT_NEAR(loop.rejection->value, 0.4, 1e-3);
  LoopVerificationOptions options;
  options.max_sigma_m = 0.41;
  judge(loop, options);
  EXPECT_EQ(loop.state, LoopState::kAccepted) << text_of(loop.rejection);
}

TEST(LoopVerification, a_scan_outside_the_space_the_local_map_has_seen_is_rejected) {
  LoopRecord loop = two_rounds().loop(kNarrow_m, {40, 0, 0});
  judge(loop);
  expect_rejected(loop, Reason::kUnobserved);
  EXPECT_EQ(loop.observed_share, 0);
}

TEST(LoopVerification, every_threshold_decides) {
  LoopRecord found = two_rounds().loop(kNarrow_m);
  judge(found);
  ASSERT_EQ(found.state, LoopState::kAccepted) << text_of(found.rejection);
  struct Threshold {
    double LoopVerificationOptions::*limit;
    double measured;
    double above;  // +1: a limit above the measured value rejects; -1: a limit below it
    LoopRejection::Reason reason;
  };
  const std::vector<Threshold> thresholds = {
      {&LoopVerificationOptions::min_response, found.response, 1, Reason::kLowResponse},
      {&LoopVerificationOptions::max_ambiguity, found.ambiguity, -1, Reason::kAmbiguous},
      {&LoopVerificationOptions::max_sigma_m, 0.01, -1, Reason::kUncertainPosition},
      {&LoopVerificationOptions::min_observed_share, found.observed_share, 1, Reason::kUnobserved},
      {&LoopVerificationOptions::min_neighbours_agree, found.neighbours_agree, 1,
       Reason::kNeighboursDisagree},
      {&LoopVerificationOptions::min_reverse_agree, found.reverse_agree, 1, Reason::kReverseDisagrees}};
  for (const Threshold& threshold : thresholds) {
    LoopVerificationOptions options;
    LoopRecord loop = two_rounds().loop(kNarrow_m);
    options.*threshold.limit = threshold.measured + threshold.above * 1e-6;
    judge(loop, options);
    expect_rejected(loop, threshold.reason);
    options.*threshold.limit = threshold.measured - threshold.above * 1e-6;
    judge(loop, options);
    EXPECT_EQ(loop.state, LoopState::kAccepted) << text_of(loop.rejection);
    EXPECT_FALSE(loop.rejection.has_value()) << "an earlier rejection is cleared";
  }
}

}  // namespace
}  // namespace psi_slam
