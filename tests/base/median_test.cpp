// SPDX-License-Identifier: BSD-3-Clause
#include "base/median.h"

#include <gtest/gtest.h>

namespace psi_slam {
namespace {

TEST(Median, is_the_middle_or_the_larger_of_both) {
  EXPECT_EQ(median({3, 1, 2}), 2);
  EXPECT_EQ(median({4, 1, 3, 2}), 3);
  EXPECT_EQ(median({7}), 7);
  EXPECT_EQ(median({}), 0);
}

}  // namespace
}  // namespace psi_slam
