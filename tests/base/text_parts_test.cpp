// SPDX-License-Identifier: BSD-3-Clause
#include "base/text_parts.h"

#include <gtest/gtest.h>

namespace psi_slam {
namespace {

TEST(TextParts, a_text_starts_with_its_beginning) {
  EXPECT_TRUE(starts_with("RAWLASER1 181", "RAWLASER"));
  EXPECT_TRUE(starts_with("RAWLASER", "RAWLASER"));
  EXPECT_TRUE(starts_with("", ""));
  EXPECT_FALSE(starts_with("RAW", "RAWLASER"));
  EXPECT_FALSE(starts_with("a RAWLASER", "RAWLASER"));
}

TEST(TextParts, space_is_trimmed_at_both_ends_only) {
  EXPECT_EQ(trimmed(" \t one two\t "), "one two");
  EXPECT_EQ(trimmed("one"), "one");
  EXPECT_EQ(trimmed(" \t "), "");
  EXPECT_EQ(trimmed(""), "");
  EXPECT_EQ(trimmed("one\r"), "one\r");
  EXPECT_EQ(trimmed("\r one\r", " \r"), "one");
}

}  // namespace
}  // namespace psi_slam
