// SPDX-License-Identifier: BSD-3-Clause
#include "base/instruction_set.h"

#include <gmock/gmock.h>

#include <cstdlib>

#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

class InstructionSetTest : public testing::Test {
 protected:
  ~InstructionSetTest() override { ::unsetenv("PSI_SLAM_MAX_INSTRUCTIONS"); }

  static void limit(const char* value) { ::setenv("PSI_SLAM_MAX_INSTRUCTIONS", value, 1); }
};

TEST_F(InstructionSetTest, a_smaller_limit_excludes_the_sets_above_it) {
  const bool has_avx2 = can_use(InstructionSet::kAvx2);
  limit("avx2");
  EXPECT_EQ(can_use(InstructionSet::kAvx2), has_avx2);
  EXPECT_FALSE(can_use(InstructionSet::kAvx512));
  limit("baseline");
  EXPECT_FALSE(can_use(InstructionSet::kAvx2));
  EXPECT_TRUE(can_use(InstructionSet::kBaseline)) << "every machine has it";
}

TEST_F(InstructionSetTest, another_value_is_refused_with_those_that_are_expected) {
  limit("sse");
  try {
    can_use(InstructionSet::kBaseline);
    FAIL() << "sse was taken";
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), testing::AllOf(testing::HasSubstr("PSI_SLAM_MAX_INSTRUCTIONS is sse"),
                                             testing::HasSubstr("baseline, avx2 or avx512")));
  }
}

}  // namespace
}  // namespace psi_slam
