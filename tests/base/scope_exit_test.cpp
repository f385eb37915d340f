// SPDX-License-Identifier: BSD-3-Clause
#include "base/scope_exit.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace psi_slam {
namespace {

TEST(ScopeExit, calls_its_function_at_the_end_and_after_an_exception) {
  int calls = 0;
  {
    const ScopeExit count([&] { ++calls; });
    EXPECT_EQ(calls, 0);
  }
  EXPECT_EQ(calls, 1);
  EXPECT_THROW(
      {
        const ScopeExit count([&] { ++calls; });
        throw std::runtime_error("an error");
      },
      std::runtime_error);
  EXPECT_EQ(calls, 2);
}

}  // namespace
}  // namespace psi_slam
