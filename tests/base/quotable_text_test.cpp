// SPDX-License-Identifier: BSD-3-Clause
#include "base/quotable_text.h"

#include <gtest/gtest.h>

namespace psi_slam {
namespace {

TEST(QuotableText, keeps_ordinary_texts) {
  EXPECT_EQ(quotable(""), "");
  EXPECT_EQ(quotable("B\xc3\xbcro\t= 1"), "B\xc3\xbcro\t= 1");
  EXPECT_EQ(quotable(std::string(80, 'a')), std::string(80, 'a'));
}

TEST(QuotableText, replaces_control_characters) {
  EXPECT_EQ(quotable({"a\0b\x1b[1m\n\x7f", 9}), "a?b?[1m??");
}

TEST(QuotableText, shortens_long_texts_between_letters) {
  EXPECT_EQ(quotable(std::string(1'000'000, 'a')), std::string(80, 'a') + "...");
  EXPECT_EQ(quotable("abcd\xc3\xbc", 5), "abcd...");
  EXPECT_EQ(quotable("abcde", 4), "abcd...");
}

}  // namespace
}  // namespace psi_slam
