// SPDX-License-Identifier: BSD-3-Clause
#include "matching/sum_kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace psi_slam {
namespace {

std::vector<InstructionSet> sets_of_this_machine() {
  std::vector<InstructionSet> sets;
  for (const InstructionSet set : kInstructionSets)
    if (sum_kernel_for(set) != nullptr) sets.push_back(set);
  return sets;
}

int rounded_up(int width) {
  return (width + kSumLanes - 1) / kSumLanes * kSumLanes;
}

// Input of a kernel: a block of sums to compute, with random cells and random initial sums.
struct Problem {
  std::ptrdiff_t row_bytes = 0;
  std::vector<std::uint8_t> cells;
  std::vector<std::int32_t> offsets;
  int width = 0;
  int height = 0;
  std::ptrdiff_t sums_row = 0;
  std::vector<std::uint32_t> sums;
};

Problem random_problem(std::mt19937_64& random, std::size_t points, int width, int height) {
  Problem problem;
  problem.width = width;
  problem.height = height;
  problem.row_bytes = 200;
  problem.cells.resize(200 * 120);
  for (auto& cell : problem.cells) cell = static_cast<std::uint8_t>(random() % 256);
  const int last = static_cast<int>(problem.cells.size()) - height * 200 - rounded_up(width);
  for (std::size_t p = 0; p < points; ++p)
    problem.offsets.push_back(std::uniform_int_distribution<std::int32_t>(0, last)(random));
  problem.sums_row = rounded_up(width) + 16;
  problem.sums.resize(static_cast<std::size_t>(problem.sums_row * height));
  for (auto& sum : problem.sums) sum = static_cast<std::uint32_t>(random() % 100'000);
  return problem;
}

std::vector<std::uint32_t> by_plain_loop(const Problem& problem) {
  std::vector<std::uint32_t> sums = problem.sums;
  for (int y = 0; y < problem.height; ++y)
    for (int x = 0; x < rounded_up(problem.width); ++x)
      for (const std::int32_t offset : problem.offsets)
        sums[static_cast<std::size_t>(y * problem.sums_row + x)] +=
            problem.cells[static_cast<std::size_t>(offset + y * problem.row_bytes + x)];
  return sums;
}

std::vector<std::uint32_t> by_kernel(const Problem& problem, InstructionSet set) {
  std::vector<std::uint32_t> sums = problem.sums;
  sum_kernel_for(set)(problem.cells.data(), problem.row_bytes, problem.offsets.data(), problem.offsets.size(),
                      problem.width, problem.height, sums.data(), problem.sums_row);
  return sums;
}

TEST(SumKernel, every_set_equals_a_plain_loop_at_every_width) {
  std::mt19937_64 random(11);
  for (int width = 1; width <= 70; ++width) {
    const Problem problem = random_problem(random, 1 + random() % 40, width, 1 + width % 19);
    const std::vector<std::uint32_t> expected = by_plain_loop(problem);
    for (const InstructionSet set : sets_of_this_machine())
      ASSERT_EQ(by_kernel(problem, set), expected) << "set " << static_cast<int>(set) << ", width " << width;
  }
}

TEST(SumKernel, every_set_equals_a_plain_loop_at_every_height) {
  std::mt19937_64 random(12);
  for (int height = 1; height <= 40; ++height) {
    const Problem problem = random_problem(random, 30, 17, height);
    const std::vector<std::uint32_t> expected = by_plain_loop(problem);
    for (const InstructionSet set : sets_of_this_machine())
      ASSERT_EQ(by_kernel(problem, set), expected)
          << "set " << static_cast<int>(set) << ", height " << height;
  }
}

// The kernel adds up in 16 bits, which hold at most 257 scores of 255.
TEST(SumKernel, many_points_of_the_highest_score_do_not_overflow) {
  std::mt19937_64 random(13);
  for (const std::size_t points : {0, 1, 255, 256, 257, 258, 513, 514, 515, 771, 2000, 5000}) {
    for (const int height : {1, 2, 4, 8, 15}) {
      Problem problem = random_problem(random, points, 20, height);
      std::fill(problem.cells.begin(), problem.cells.end(), std::uint8_t{255});
      const std::vector<std::uint32_t> expected = by_plain_loop(problem);
      EXPECT_EQ(expected[0], problem.sums[0] + 255 * points);
      for (const InstructionSet set : sets_of_this_machine())
        ASSERT_EQ(by_kernel(problem, set), expected)
            << "set " << static_cast<int>(set) << ", " << points << " points";
    }
  }
}

TEST(SumKernel, offsets_may_point_before_the_first_cell) {
  std::mt19937_64 random(14);
  Problem problem = random_problem(random, 50, 33, 7);
  const std::vector<std::uint32_t> expected = by_plain_loop(problem);
  constexpr std::int32_t kBack = 3000;
  for (std::int32_t& offset : problem.offsets) offset -= kBack;
  for (const InstructionSet set : sets_of_this_machine()) {
    std::vector<std::uint32_t> sums = problem.sums;
    sum_kernel_for(set)(problem.cells.data() + kBack, problem.row_bytes, problem.offsets.data(),
                        problem.offsets.size(), problem.width, problem.height, sums.data(), problem.sums_row);
    EXPECT_EQ(sums, expected) << "set " << static_cast<int>(set);
  }
}

TEST(SumKernel, the_one_in_use_is_the_widest_of_this_machine) {
  const std::vector<InstructionSet> sets = sets_of_this_machine();
  ASSERT_FALSE(sets.empty());
  EXPECT_EQ(sets.front(), InstructionSet::kBaseline) << "the baseline kernel runs on every machine";
  EXPECT_EQ(sum_kernel(), sum_kernel_for(sets.back()));
}

TEST(SumKernel, avx2_has_code_of_its_own) {
  if (sets_of_this_machine().size() == 1) GTEST_SKIP() << "this machine has the baseline only";
  EXPECT_NE(sum_kernel_for(InstructionSet::kAvx2), sum_kernel_for(InstructionSet::kBaseline));
}

}  // namespace
}  // namespace psi_slam
