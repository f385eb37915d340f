// SPDX-License-Identifier: BSD-3-Clause
#include "base/descriptor.h"

#include <fcntl.h>
#include <gtest/gtest.h>

#include <utility>

namespace psi_slam {
namespace {

bool is_open(int number) {
  return ::fcntl(number, F_GETFD) >= 0;
}

Descriptor null_device() {
  return Descriptor(::open("/dev/null", O_WRONLY | O_CLOEXEC));
}

TEST(Descriptor, closes_its_file_once) {
  int number = -1;
  {
    Descriptor first = null_device();
    number = first.number();
    const Descriptor moved = std::move(first);
    EXPECT_EQ(moved.number(), number);
    EXPECT_TRUE(is_open(number));
  }
  EXPECT_FALSE(is_open(number));
}

TEST(Descriptor, is_closed_by_hand_and_replaced_by_another) {
  EXPECT_FALSE(Descriptor().is_open());
  Descriptor file = null_device();
  const int number = file.number();
  file.close();
  EXPECT_FALSE(file.is_open());
  EXPECT_FALSE(is_open(number));
  file = null_device();
  EXPECT_TRUE(is_open(file.number()));
}

}  // namespace
}  // namespace psi_slam
