// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/mapper.h"

#include "mapping/mapper_options.h"

#include <gtest/gtest.h>
#include <mrpt/math/wrap2pi.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "local_maps/simulated_drive.h"
#include "logs/frames/pose_operations.h"
#include "same_map.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

// A run once around the corridor and along its first part again, with biased and noisy odometry.
const SimulatedDrive& office_drive() {
  static const SimulatedDrive drive = [] {
    OdometryErrors errors;
    errors.length_factor = 0.96;
    errors.length_share = 0.1;
    errors.turn_factor = 1.05;
    errors.turn_share = 0.1;
    errors.drift_rad_per_m = 0.01;
    return drive_along(
        office_floor(),
        path_along({{1.6, 1.6}, {18.3, 1.6}, {18.3, 12.4}, {1.6, 12.4}, {1.6, 1.6}, {14, 1.6}}, 0.16, 0.12),
        errors, 11);
  }();
  return drive;
}

MappingResult map_of(const std::vector<Frame>& frames, const MapperOptions& options = {}) {
  Mapper mapper(options);
  for (const Frame& frame : frames) mapper.add(frame);
  return mapper.finish();
}

const MappingResult& office_map() {
  static const MappingResult result = map_of(office_drive().frames);
  return result;
}

void expect_consistent(const MappingResult& result, std::size_t frames) {
  ASSERT_EQ(result.frames.size(), frames);
  ASSERT_EQ(result.log.size(), frames);
  ASSERT_EQ(result.graph.num_nodes(), result.node_frames.size());
  for (std::size_t i = 0; i < frames; ++i) {
    const TPose2D& pose = result.frames[i].map_T_robot;
    ASSERT_TRUE(std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.phi)) << "scan " << i;
    EXPECT_EQ(result.frames[i].time_us, result.log[i].time_us);
    if (result.frames[i].node) {
      ASSERT_LT(*result.frames[i].node, result.node_frames.size());
      EXPECT_EQ(result.node_frames[*result.frames[i].node], i);
    }
  }
  for (std::size_t node = 0; node < result.node_frames.size(); ++node) {
    ASSERT_LT(result.node_frames[node], frames);
    const FrameRecord& frame = result.frames[result.node_frames[node]];
    EXPECT_EQ(frame.node, node);
    const TPose2D& pose = result.graph.pose(node);
    EXPECT_NEAR(pose.x, frame.map_T_robot.x, 1e-9);
    EXPECT_NEAR(pose.y, frame.map_T_robot.y, 1e-9);
    EXPECT_NEAR(mrpt::math::wrapToPi(pose.phi - frame.map_T_robot.phi), 0, 1e-9);
  }
  for (const LocalMapRecord& local_map : result.local_maps) {
    EXPECT_LE(local_map.first_node, local_map.last_node);
    EXPECT_LT(local_map.last_node, result.node_frames.size());
    EXPECT_EQ(local_map.anchor, local_map.first_node);
  }
  for (const LoopRecord& loop : result.loops) {
    ASSERT_LT(loop.local_map, result.local_maps.size());
    EXPECT_EQ(loop.anchor, result.local_maps[loop.local_map].anchor);
    EXPECT_EQ(loop.frame, result.node_frames[loop.node]);
    EXPECT_EQ(loop.state == LoopState::kAccepted, !loop.rejection.has_value()) << text_of(loop.rejection);
    EXPECT_NE(loop.state, LoopState::kCandidate) << "no loop is a candidate at the end";
  }
}

std::size_t accepted_loops(const MappingResult& result) {
  return static_cast<std::size_t>(
      std::count_if(result.loops.begin(), result.loops.end(),
                    [](const LoopRecord& loop) { return loop.state == LoopState::kAccepted; }));
}

void expect_no_false_loop(const MappingResult& result, const std::vector<TPose2D>& truth) {
  for (const LoopRecord& loop : result.loops) {
    if (loop.state != LoopState::kAccepted) continue;
    const TPose2D off =
        loop.anchor_T_node - (truth[result.node_frames[loop.node]] - truth[result.node_frames[loop.anchor]]);
    EXPECT_LT(std::hypot(off.x, off.y), 0.3) << loop.node << " seen from " << loop.anchor;
    EXPECT_LT(std::abs(off.phi), 0.1) << loop.node << " seen from " << loop.anchor;
  }
}

TEST(Mapper, brings_the_robot_home_after_a_loop) {
  const SimulatedDrive& drive = office_drive();
  const MappingResult& result = office_map();
  ASSERT_EQ(result.frames.size(), drive.frames.size());
  double odometry_m = 0;
  double map_m = 0;
  for (std::size_t i = 0; i < drive.frames.size(); ++i) {
    odometry_m = std::max(odometry_m, distance_m(drive.frames[i].odom_T_robot, drive.map_T_robot[i]));
    map_m = std::max(map_m, distance_m(result.frames[i].map_T_robot, drive.map_T_robot[i]));
  }
  EXPECT_GT(odometry_m, 3) << "odometry alone has a large error";
  EXPECT_LT(map_m, 0.15);
  const TPose2D& last = result.frames.back().map_T_robot;
  EXPECT_LT(distance_m(last, drive.map_T_robot.back()), 0.15);
  EXPECT_LT(std::abs(mrpt::math::wrapToPi(last.phi - drive.map_T_robot.back().phi)), 0.02);
}

TEST(Mapper, accepts_true_loops_and_no_false_one) {
  EXPECT_GT(accepted_loops(office_map()), 5U);
  expect_no_false_loop(office_map(), office_drive().map_T_robot);
}

TEST(Mapper, closes_loops_while_mapping_and_in_the_final_search) {
  const auto& loops = office_map().loops;
  for (const bool in_final_search : {false, true})
    EXPECT_TRUE(std::any_of(loops.begin(), loops.end(), [&](const LoopRecord& loop) {
      return loop.in_final_search == in_final_search && loop.state == LoopState::kAccepted;
    })) << in_final_search;
}

TEST(Mapper, every_scan_has_a_pose_and_the_graph_fits_them) {
  expect_consistent(office_map(), office_drive().frames.size());
  EXPECT_GT(office_map().node_frames.size(), 100U);
  EXPECT_GT(office_map().local_maps.size(), 3U);
}

TEST(Mapper, gives_the_pose_of_the_robot_while_mapping) {
  const SimulatedDrive& drive = office_drive();
  MapperOptions options;
  options.back_end.final_search.passes = 0;
  Mapper mapper(options);
  EXPECT_EQ(mapper.map_T_robot(), TPose2D(0, 0, 0));
  double largest_m = 0;
  for (std::size_t i = 0; i < 150; ++i) {
    const FrameRecord& record = mapper.add(drive.frames[i]);
    EXPECT_EQ(record.time_us, drive.frames[i].time_us);
    EXPECT_EQ(mapper.frames().size(), i + 1);
    EXPECT_EQ(mapper.log().size(), i + 1);
    largest_m = std::max(largest_m, distance_m(mapper.map_T_robot(), drive.map_T_robot[i]));
  }
  EXPECT_LT(largest_m, 0.15);
  EXPECT_GT(mapper.graph().num_nodes(), 50U);
}

TEST(Mapper, tells_the_pose_of_a_scan_before_drawing_it) {
  Mapper mapper{MapperOptions()};
  std::vector<TPose2D> told;
  mapper.set_pose_observer([&](const FrameRecord& record) {
    told.push_back(record.map_T_robot);
    if (record.node && *record.node > 0) {
      EXPECT_LT(mapper.active_local_maps().front().last_node, *record.node);
    }
  });
  for (std::size_t i = 0; i < 60; ++i) {
    const FrameRecord& record = mapper.add(office_drive().frames[i]);
    ASSERT_EQ(told.size(), i + 1);
    EXPECT_EQ(told.back(), record.map_T_robot);
    if (record.node) {
      EXPECT_EQ(mapper.active_local_maps().front().last_node, *record.node);
    }
  }
  EXPECT_GT(mapper.keyframes().nodes.size(), 20U);
}

TEST(Mapper, estimates_the_covariance_of_each_pose_without_changing_it) {
  constexpr double kChiSquare99 = 11.345;  // three degrees of freedom
  std::vector<Eigen::Matrix3d> told[2];
  std::size_t beyond = 0;
  for (const bool thread : {false, true}) {
    MapperOptions options;
    options.estimates_covariance = true;
    options.back_end_thread = thread;
    Mapper mapper(options);
    mapper.set_pose_observer([&](const FrameRecord& record) {
      const auto covariance = mapper.newest_covariance();
      if (!covariance) return;
      told[thread].push_back(*covariance);
      const TPose2D& truth = office_drive().map_T_robot[mapper.frames().size() - 1];
      const Eigen::Vector3d error(record.map_T_robot.x - truth.x, record.map_T_robot.y - truth.y,
                                  mrpt::math::wrapToPi(record.map_T_robot.phi - truth.phi));
      if (error.dot(covariance->ldlt().solve(error)) > kChiSquare99) ++beyond;
    });
    for (const Frame& frame : office_drive().frames) mapper.add(frame);
    if (thread) continue;
    const MappingResult result = mapper.finish();
    ASSERT_EQ(result.frames.size(), office_map().frames.size());
    EXPECT_EQ(result.frames.back().map_T_robot, office_map().frames.back().map_T_robot);
  }
  ASSERT_GT(told[0].size(), office_drive().frames.size() * 9 / 10);
  EXPECT_TRUE(told[0] == told[1]) << "the thread has no effect";
  EXPECT_LT(beyond, told[0].size() / 5) << "of twice as many poses";
  EXPECT_GT(told[0].back().trace(), 0);
  EXPECT_EQ(Mapper().newest_covariance(), std::nullopt);
}

TEST(Mapper, the_same_log_gives_the_same_poses_to_the_last_bit) {
  const MappingResult again = map_of(office_drive().frames);
  const MappingResult& first = office_map();
  ASSERT_EQ(again.frames.size(), first.frames.size());
  for (std::size_t i = 0; i < first.frames.size(); ++i) {
    ASSERT_EQ(again.frames[i].map_T_robot.x, first.frames[i].map_T_robot.x) << "scan " << i;
    ASSERT_EQ(again.frames[i].map_T_robot.y, first.frames[i].map_T_robot.y) << "scan " << i;
    ASSERT_EQ(again.frames[i].map_T_robot.phi, first.frames[i].map_T_robot.phi) << "scan " << i;
  }
  ASSERT_EQ(again.loops.size(), first.loops.size());
  for (std::size_t i = 0; i < first.loops.size(); ++i) {
    EXPECT_EQ(again.loops[i].node, first.loops[i].node);
    EXPECT_EQ(again.loops[i].state, first.loops[i].state);
    EXPECT_EQ(again.loops[i].response, first.loops[i].response);
  }
}

TEST(Mapper, any_number_of_threads_makes_the_same_map) {
  for (const int threads : {2, 4}) {
    SCOPED_TRACE(threads);
    MapperOptions options;
    options.back_end.threads = threads;
    expect_same_map(office_map(), map_of(office_drive().frames, options));
  }
}

TEST(Mapper, counts_the_loops_that_became_constraints_at_each_frame) {
  MapperOptions options;
  // Most windows count as wide, so many loops are candidates.
  options.back_end.loop_closure.verification.wide_window_m = options.back_end.final_search.window_m;
  Mapper mapper(options);
  for (const Frame& frame : office_drive().frames) mapper.add(frame);
  const std::vector<LoopRecord> loops = mapper.loops();  // before those after the last scan
  const MappingResult result = mapper.finish();
  std::size_t counted = 0;
  bool several_at_once = false;
  for (const FrameRecord& frame : result.frames) {
    counted += static_cast<std::size_t>(frame.loops_accepted);
    several_at_once = several_at_once || frame.loops_accepted > frame.loops_tried;
    EXPECT_TRUE(frame.node || frame.loops_accepted == 0);
  }
  std::size_t constraints = 0;
  for (const LoopRecord& loop : loops) constraints += loop.state == LoopState::kAccepted ? 1 : 0;
  EXPECT_EQ(counted, constraints);
  EXPECT_TRUE(several_at_once) << "loops found at earlier frames were confirmed";
}

TEST(Mapper, counts_attempts_without_a_match) {
  const MappingResult& result = office_map();
  LoopEffort sum;
  LoopEffort final_search;
  std::size_t accepted = 0;
  for (const auto& [name, matcher] : result.loop_matchers) {
    sum += matcher.effort;
    final_search += matcher.final_search_effort;
    accepted += matcher.accepted;
  }
  const auto not_found = std::count_if(result.loops.begin(), result.loops.end(),
                                       [](const LoopRecord& loop) { return found_nothing(loop); });
  EXPECT_EQ(sum.found, result.loops.size() - static_cast<std::size_t>(not_found));
  EXPECT_GT(sum.attempts, sum.found);
  EXPECT_EQ(accepted, accepted_loops(result));
  EXPECT_GT(final_search.attempts, 0U);

  SearchCost by_search;
  for (const SearchKind search : kSearchKinds) by_search += sum.of(search);
  EXPECT_EQ(by_search.attempts, sum.attempts);
  EXPECT_EQ(by_search.evaluations, sum.evaluations);
  EXPECT_GT(sum.of(SearchKind::kLocal).attempts, 0U) << "small windows of genetic matchers";
  MapperOptions csm;
  csm.back_end.matcher = MatcherKind::kCsm;
  const MappingResult by_csm = map_of(office_drive().frames, csm);
  EXPECT_GT(by_csm.loop_matchers.at(MatcherKind::kCsm).effort.of(SearchKind::kExhaustive).attempts, 0U)
      << "small windows of csm";

  LoopEffort of_frames;
  for (const FrameRecord& frame : result.frames) {
    of_frames.attempts += static_cast<std::size_t>(frame.loops_tried);
    of_frames.evaluations += frame.loop_evaluations;
    of_frames.milliseconds += frame.loop_matching_ms;
    EXPECT_GE(frame.evaluations, frame.loop_evaluations);
    EXPECT_EQ(frame.loops_tried > 0, frame.loop_evaluations > 0);
    EXPECT_EQ(std::accumulate(frame.searches.begin(), frame.searches.end(), 0), frame.loops_tried);
  }
  EXPECT_EQ(of_frames.attempts, sum.attempts - final_search.attempts);
  EXPECT_EQ(of_frames.evaluations, sum.evaluations - final_search.evaluations);
  EXPECT_NEAR(of_frames.milliseconds, sum.milliseconds - final_search.milliseconds, 1e-6);
  std::int64_t of_loops = 0;
  for (const LoopRecord& loop : result.loops) of_loops += loop.evaluations;
  EXPECT_GT(sum.evaluations, of_loops);
}

// Computes Psi directly from equations 13 and 14. Checks the mean of accepted loops over the last searches at
// every frame, and eta at the frames before the first loop moves the map.
TEST(Mapper, records_the_factor_of_loop_closing) {
  const MappingResult& result = office_map();
  const auto window = static_cast<std::size_t>(PsiOptions().window_frames);
  std::vector<int> loops;
  double path_m = 0;
  bool any_loop = false;
  double largest_psi = 0;
  for (std::size_t i = 0; i < result.frames.size(); ++i) {
    const FrameRecord& frame = result.frames[i];
    if (i > 0) path_m += distance_m(frame.odom_T_robot, result.frames[i - 1].odom_T_robot);
    double mean = 0;
    const std::size_t count = std::min(window, loops.size());
    for (std::size_t k = loops.size() - count; k < loops.size(); ++k)
      mean += static_cast<double>(loops[k]) / static_cast<double>(count);
    ASSERT_NEAR(frame.mean_loops, mean, 1e-12) << "scan " << i;
    ASSERT_NEAR(frame.psi, frame.eta * mean, 1e-9) << "scan " << i;
    ASSERT_LE(frame.eta, PsiOptions().eta_max);
    if (!any_loop && i > 0) {
      const double from_start_m = distance_m(frame.front_end_T_robot, result.frames[0].front_end_T_robot);
      ASSERT_NEAR(frame.eta, std::min(path_m / from_start_m, PsiOptions().eta_max), 1e-9) << "scan " << i;
    }
    if (frame.searched_loops) loops.push_back(frame.loops_accepted);
    ASSERT_TRUE(frame.node || !frame.searched_loops);
    ASSERT_TRUE(frame.searched_loops || frame.loops_tried + frame.loops_accepted == 0) << "scan " << i;
    any_loop = any_loop || frame.loops_accepted > 0;
    largest_psi = std::max(largest_psi, frame.psi);
  }
  EXPECT_GT(largest_psi, 1);
}

TEST(Mapper, uses_the_matcher_chosen_by_psi_and_that_of_frequent_loops_in_the_final_search) {
  const MappingResult& result = office_map();
  std::size_t genetic_in_final_search = 0;
  for (const FrameRecord& frame : result.frames) {
    const MatcherKind kind = matcher_kind(std::nullopt, {}, frame.psi);
    EXPECT_EQ(frame.matcher, frame.node ? std::optional(kind) : std::nullopt);
  }
  for (const LoopRecord& loop : result.loops) {
    if (!loop.in_final_search) continue;
    EXPECT_EQ(loop.matcher, MatcherKind::kGa);
    ++genetic_in_final_search;
  }
  EXPECT_GT(genetic_in_final_search, 0U);
  EXPECT_GT(result.loop_matchers.size(), 1U);

  MapperOptions options;
  options.back_end.psi.psi_1 = 0.5;
  options.back_end.psi.psi_2 = 7;
  const MappingResult by_thresholds = map_of(office_drive().frames, options);
  std::set<MatcherKind> used;
  for (const FrameRecord& frame : by_thresholds.frames) {
    const MatcherKind kind = matcher_kind(std::nullopt, options.back_end.psi, frame.psi);
    EXPECT_EQ(frame.matcher, frame.node ? std::optional(kind) : std::nullopt);
    if (frame.node) used.insert(*frame.matcher);
  }
  EXPECT_EQ(used, (std::set<MatcherKind>{kMatcherKinds.begin(), kMatcherKinds.end()}));
  expect_no_false_loop(by_thresholds, office_drive().map_T_robot);

  options.back_end.matcher = MatcherKind::kCsmGa;
  const MappingResult fixed = map_of(office_drive().frames, options);
  ASSERT_EQ(fixed.loop_matchers.size(), 1U);
  EXPECT_EQ(fixed.loop_matchers.begin()->first, MatcherKind::kCsmGa);
}

TEST(Mapper, outlier_loops_are_rejected_without_a_final_search_too) {
  MapperOptions options;
  options.back_end.final_search.passes = 0;
  LoopVerificationOptions& verification = options.back_end.loop_closure.verification;
  verification.max_ambiguity = 1;
  verification.min_response = verification.min_context_response = 0.1;
  verification.min_observed_share = verification.min_neighbours_agree = verification.min_reverse_agree = 0;
  Mapper mapper(options);
  for (const Frame& frame : office_drive().frames) mapper.add(frame);
  const auto& loops = mapper.loops();
  const auto true_loop = std::find_if(
      loops.begin(), loops.end(), [](const LoopRecord& loop) { return loop.state == LoopState::kAccepted; });
  ASSERT_NE(true_loop, loops.end());
  // A person has it matched again 1.5 m along the corridor.
  LoopEdit edit{LoopEdit::Kind::kMatch, true_loop->frame, true_loop->local_map};
  edit.place = LoopPlace{true_loop->anchor_T_node + TPose2D(1.5, 0, 0), {0.3, 0.3, 0.05}};
  ASSERT_EQ(mapper.edit(edit).state, LoopEditOutcome::State::kDone);
  ASSERT_EQ(true_loop->state, LoopState::kAccepted);
  const MappingResult result = mapper.finish();
  expect_consistent(result, office_drive().frames.size());
  std::size_t off = 0;
  for (const LoopRecord& loop : result.loops) {
    if (!is_outlier(loop)) continue;
    ++off;
    EXPECT_EQ(loop.state, LoopState::kRejected);
  }
  EXPECT_GT(off, 0U);
  EXPECT_GT(accepted_loops(result), 0U);
}

TEST(Mapper, without_loop_closing_poses_are_those_of_the_front_end) {
  MapperOptions options;
  options.close_loops = false;
  const std::vector<Frame>& frames = office_drive().frames;
  const MappingResult result = map_of(frames, options);
  expect_consistent(result, frames.size());
  EXPECT_TRUE(result.loops.empty());
  for (const FrameRecord& frame : result.frames) {
    EXPECT_EQ(frame.loops_tried, 0);
    EXPECT_NEAR(distance_m(frame.map_T_robot, frame.front_end_T_robot), 0, 1e-9);
  }
}

// The laser is covered along some metres of the corridor, so only odometry is available there.
TEST(Mapper, loops_correct_the_error_of_a_blind_stretch) {
  SimulatedDrive drive = office_drive();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 190; i < 250; ++i) {
    auto& ranges = drive.frames[i].scan.ranges_m;
    std::fill(ranges.begin(), ranges.end(), nan);
  }
  const auto error_m = [&](const MappingResult& result) {
    return distance_m(result.frames.back().map_T_robot, drive.map_T_robot.back());
  };
  MapperOptions open;
  open.close_loops = false;
  const double lost_m = error_m(map_of(drive.frames, open));
  const MappingResult result = map_of(drive.frames);
  expect_consistent(result, drive.frames.size());
  EXPECT_EQ(result.frames[0].match, ScanMatch::kNoMap);
  for (std::size_t i = 1; i < result.frames.size(); ++i) {
    const bool blind = i >= 190 && i <= 250;  // scan 250 has returns, but its local map has none
    EXPECT_EQ(result.frames[i].match, blind ? ScanMatch::kUnmatched : ScanMatch::kMatched) << "frame " << i;
  }
  EXPECT_GT(lost_m, 0.5) << "the front end alone has this error";
  EXPECT_LT(error_m(result), 0.15);
  EXPECT_GT(accepted_loops(result), 0U);
  expect_no_false_loop(result, drive.map_T_robot);
}

TEST(Mapper, finishing_reports_its_progress_up_to_the_end) {
  Mapper mapper;
  for (const Frame& frame : office_drive().frames) mapper.add(frame);
  std::vector<double> shares;
  const MappingResult result = mapper.finish([&](double share) {
    shares.push_back(share);
    return share < 1;
  });
  ASSERT_FALSE(shares.empty());
  EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
  EXPECT_GT(shares.front(), 0);
  EXPECT_EQ(shares.back(), 1);
  EXPECT_FALSE(result.interrupted) << "a stop at the end has no effect";
  for (std::size_t i = 0; i < result.frames.size(); ++i)
    EXPECT_EQ(result.frames[i].map_T_robot, office_map().frames[i].map_T_robot) << "frame " << i;
}

TEST(Mapper, refines_all_scans_at_the_end_and_keeps_the_frame_of_the_first) {
  const SimulatedDrive& drive = office_drive();
  MapperOptions unrefined;
  unrefined.back_end.joint_refinement.rounds = 0;
  const MappingResult before = map_of(drive.frames, unrefined);
  const MappingResult& after = office_map();
  expect_consistent(before, drive.frames.size());
  EXPECT_EQ(after.frames.front().map_T_robot, before.frames.front().map_T_robot);
  const auto turn_error_rad = [&](const MappingResult& result) {
    double sum = 0;
    for (std::size_t i = 0; i + 5 < result.frames.size(); ++i) {
      const TPose2D off = (result.frames[i + 5].map_T_robot - result.frames[i].map_T_robot) -
                          (drive.map_T_robot[i + 5] - drive.map_T_robot[i]);
      sum += std::abs(mrpt::math::wrapToPi(off.phi));
    }
    return sum / static_cast<double>(result.frames.size());
  };
  EXPECT_LT(turn_error_rad(after), 0.8 * turn_error_rad(before));
}

TEST(Mapper, refinement_can_be_cut_short) {
  MapperOptions options;
  options.back_end.final_search.passes = 0;
  Mapper mapper(options);
  for (const Frame& frame : office_drive().frames) mapper.add(frame);
  const MappingResult result = mapper.finish([](double) { return false; });
  EXPECT_TRUE(result.interrupted);
  EXPECT_TRUE(result.final_search_cut_short);
  expect_consistent(result, office_drive().frames.size());
}

TEST(Mapper, the_final_search_can_be_cut_short) {
  Mapper mapper;
  for (const Frame& frame : office_drive().frames) mapper.add(frame);
  int calls = 0;
  const MappingResult result = mapper.finish([&](double) { return ++calls < 3; });
  EXPECT_EQ(calls, 3);
  EXPECT_TRUE(result.final_search_cut_short);
  EXPECT_TRUE(result.interrupted);
  expect_consistent(result, office_drive().frames.size());
  EXPECT_LT(result.loops.size(), office_map().loops.size());
  EXPECT_LT(distance_m(result.frames.back().map_T_robot, office_drive().map_T_robot.back()), 0.2)
      << "the result keeps the loops found before the stop";
}

TEST(Mapper, an_empty_log_gives_an_empty_map) {
  const MappingResult result = map_of({});
  expect_consistent(result, 0);
  EXPECT_TRUE(result.node_frames.empty());
  EXPECT_TRUE(result.loops.empty());
}

TEST(Mapper, one_scan_lies_at_the_origin) {
  Frame frame = office_drive().frames.front();
  frame.odom_T_robot = {7, -3, 1};
  const MappingResult result = map_of({frame});
  expect_consistent(result, 1);
  ASSERT_EQ(result.node_frames.size(), 1U);
  EXPECT_EQ(result.frames[0].map_T_robot, TPose2D(0, 0, 0));
  EXPECT_EQ(result.frames[0].odom_T_robot, TPose2D(7, -3, 1));
}

TEST(Mapper, scans_without_a_return_follow_odometry) {
  std::vector<Frame> frames(office_drive().frames.begin(), office_drive().frames.begin() + 60);
  for (Frame& frame : frames)
    std::fill(frame.scan.ranges_m.begin(), frame.scan.ranges_m.end(),
              std::numeric_limits<float>::quiet_NaN());
  const MappingResult result = map_of(frames);
  expect_consistent(result, frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i)
    EXPECT_LT(distance_m(result.frames[i].map_T_robot, frames[i].odom_T_robot - frames[0].odom_T_robot),
              1e-6);
}

TEST(Mapper, scans_without_a_beam_do_no_harm) {
  std::vector<Frame> frames(office_drive().frames.begin(), office_drive().frames.begin() + 60);
  for (std::size_t i = 0; i < frames.size(); i += 3) {
    frames[i].scan.ranges_m.clear();
    frames[i].scan.bearings_rad = std::make_shared<const std::vector<float>>();
  }
  const MappingResult result = map_of(frames);
  expect_consistent(result, frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i)
    EXPECT_LT(distance_m(result.frames[i].map_T_robot, office_drive().map_T_robot[i]), 0.2) << "scan " << i;
}

}  // namespace
}  // namespace psi_slam
