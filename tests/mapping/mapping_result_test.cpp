// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/mapping_result.h"

#include <gtest/gtest.h>

namespace psi_slam {
namespace {

/// Three runs of four, three and two frames. Nodes are every second frame of the first run and all frames of
/// the later runs.
MappingResult three_drives() {
  MappingResult result;
  result.frames.resize(9);
  result.later_run_frames = {4, 7};
  result.node_frames = {0, 2, 4, 5, 6, 7, 8};
  return result;
}

LoopRecord loop(std::size_t anchor, std::size_t node, LoopState state = LoopState::kAccepted) {
  LoopRecord record;
  record.anchor = anchor;
  record.node = node;
  record.state = state;
  return record;
}

TEST(MappingResult, gives_the_frames_of_each_run) {
  const std::vector<FrameSpan> runs = runs_of(three_drives());
  ASSERT_EQ(runs.size(), 3U);
  EXPECT_EQ(runs[0].begin, 0U);
  EXPECT_EQ(runs[0].end, 4U);
  EXPECT_EQ(runs[1].begin, 4U);
  EXPECT_EQ(runs[1].end, 7U);
  EXPECT_EQ(runs[2].end, 9U);
  EXPECT_EQ(runs_of({}).size(), 1U);
}

TEST(MappingResult, only_accepted_loops_with_other_runs_join_a_run) {
  MappingResult result = three_drives();
  EXPECT_EQ(unjoined_log(result), 1U) << "without loops, run 1 is the first unjoined run";
  result.loops = {loop(0, 2), loop(5, 6)};
  EXPECT_EQ(unjoined_log(result), 2U) << "a loop within run 2 does not join it to another run";
  result.loops.push_back(loop(3, 5, LoopState::kRejected));
  EXPECT_EQ(unjoined_log(result), 2U);
  result.loops.push_back(loop(6, 3));
  EXPECT_EQ(unjoined_log(result), std::nullopt);
  result.loops.clear();
  result.interruptions = {{result.later_run_frames[0], std::nullopt}};
  EXPECT_EQ(unjoined_log(result), 1U) << "run 2 begins log 1, because run 1 begins at an interruption";
  EXPECT_EQ(logs_of(result).size(), 2U);
  EXPECT_EQ(unjoined_log({}), std::nullopt) << "one run needs no loop";
}

TEST(MappingResult, runs_joined_in_two_groups_are_not_one_map) {
  MappingResult result = three_drives();
  result.later_run_frames = {2, 4, 7};
  result.loops = {loop(0, 1), loop(6, 3)};
  EXPECT_EQ(unjoined_log(result), 2U);
  result.loops.push_back(loop(1, 5));
  EXPECT_EQ(unjoined_log(result), std::nullopt);
  result.loops = {loop(5, 2), loop(1, 5), loop(0, 2)};
  EXPECT_EQ(unjoined_log(result), std::nullopt) << "the order of the loops does not matter";
}

}  // namespace
}  // namespace psi_slam
