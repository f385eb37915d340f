// SPDX-License-Identifier: BSD-3-Clause
#include "base/failure_notice.h"

#include <gtest/gtest.h>

namespace psi_slam {
namespace {

TEST(FailureNotice, tells_each_beginning_and_end_once) {
  FailureNotice notice("the journal");
  EXPECT_EQ(notice.news(std::nullopt), std::nullopt);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(notice.news("no room"),
              "the journal is not written for now, and psi-slam tries again: no room");
    EXPECT_EQ(notice.news("no room"), std::nullopt);
    EXPECT_EQ(notice.news("no permission"), std::nullopt);
    EXPECT_EQ(notice.news(std::nullopt), "the journal is written again");
    EXPECT_EQ(notice.news(std::nullopt), std::nullopt);
  }
}

}  // namespace
}  // namespace psi_slam
