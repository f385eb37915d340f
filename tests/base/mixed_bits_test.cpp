// SPDX-License-Identifier: BSD-3-Clause
#include "base/mixed_bits.h"

#include <gtest/gtest.h>

namespace psi_slam {
namespace {

TEST(MixedBits, are_the_numbers_of_split_mix_64) {  // its first two of seed 0, as published with it
  EXPECT_EQ(mixed_bits(0), 0xe220a8397b1dcdafU);
  EXPECT_EQ(mixed_bits(0x9e3779b97f4a7c15), 0x6e789e6aa1b965f4U);
}

}  // namespace
}  // namespace psi_slam
