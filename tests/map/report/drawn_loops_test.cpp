// SPDX-License-Identifier: BSD-3-Clause
#include "map/report/drawn_loops.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace psi_slam {
namespace {

std::vector<LoopRecord> loops_with(LoopState state, std::size_t count) {
  LoopRecord loop;
  loop.state = state;
  return std::vector<LoopRecord>(count, loop);
}

std::size_t count_drawn(const std::vector<LoopRecord>& loops, LoopRejection::Reason reason) {
  const std::vector<std::size_t> drawn = drawn_loops(loops);
  return static_cast<std::size_t>(std::count_if(
      drawn.begin(), drawn.end(), [&](std::size_t i) { return rejected_by(loops[i], reason); }));
}

TEST(DrawnLoops, are_all_loops_if_there_are_few) {
  const std::vector<std::size_t> drawn = drawn_loops(loops_with(LoopState::kAccepted, kMaxLoopsDrawn));
  ASSERT_EQ(drawn.size(), kMaxLoopsDrawn);
  EXPECT_TRUE(std::is_sorted(drawn.begin(), drawn.end()));
  EXPECT_TRUE(drawn_loops({}).empty());
}

TEST(DrawnLoops, are_sampled_evenly_if_there_are_many) {
  const std::vector<std::size_t> drawn = drawn_loops(loops_with(LoopState::kAccepted, 3700));
  ASSERT_EQ(drawn.size(), kMaxLoopsDrawn);
  for (std::size_t i = 1; i < drawn.size(); ++i) {
    EXPECT_GE(drawn[i] - drawn[i - 1], 7U);
    EXPECT_LE(drawn[i] - drawn[i - 1], 8U);
  }
  EXPECT_LT(drawn.front(), 8U);
  EXPECT_GE(drawn.back(), 3692U);
}

TEST(DrawnLoops, are_sampled_for_each_kind_separately) {
  using Reason = LoopRejection::Reason;
  std::vector<LoopRecord> loops = loops_with(LoopState::kCandidate, 4000);
  for (std::size_t i = 0; i < loops.size(); ++i)
    reject(loops[i], {i < 2000 ? Reason::kNothingFound : Reason::kLowResponse});
  for (std::size_t i = 0; i < 3; ++i) reject(loops[2000 + 500 * i], {Reason::kContradicted});
  EXPECT_EQ(count_drawn(loops, Reason::kLowResponse), kMaxLoopsDrawn);
  EXPECT_EQ(count_drawn(loops, Reason::kContradicted), 3U);
  EXPECT_EQ(count_drawn(loops, Reason::kNothingFound), 0U) << "there is no match to draw";
}

TEST(DrawnLoops, include_every_loop_that_a_person_edited) {
  std::vector<LoopRecord> loops = loops_with(LoopState::kAccepted, 2000);
  for (std::size_t i = 0; i < 700; ++i) loops[2 * i + 1].by_hand = true;
  const std::vector<std::size_t> drawn = drawn_loops(loops);
  for (std::size_t i = 0; i < 700; ++i)
    EXPECT_TRUE(std::binary_search(drawn.begin(), drawn.end(), 2 * i + 1)) << i;
  EXPECT_EQ(drawn.size(), 700 + kMaxLoopsDrawn);
}

}  // namespace
}  // namespace psi_slam
