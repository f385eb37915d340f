// SPDX-License-Identifier: BSD-3-Clause
#include "base/allocation_limit.h"

#include <gtest/gtest.h>
#include <mrpt/core/aligned_allocator.h>

#include <array>
#include <deque>
#include <memory>
#include <new>
#include <thread>
#include <vector>

namespace psi_slam {
namespace {

constexpr std::size_t kLimit_bytes = 1 << 20;

template <typename Allocator = std::allocator<char>>
void allocate(std::size_t bytes) {
  const std::vector<char, Allocator> memory(bytes);
  EXPECT_EQ(memory.size(), bytes);
}

TEST(AllocationLimit, refuses_what_exceeds_it_while_it_lives) {
  {
    const AllocationLimit limit(kLimit_bytes);
    EXPECT_THROW(allocate(kLimit_bytes + 1), std::bad_alloc);
    EXPECT_THROW(std::make_unique<char[]>(kLimit_bytes + 1), std::bad_alloc);
    EXPECT_EQ(new (std::nothrow) char[kLimit_bytes + 1], nullptr);
    allocate(kLimit_bytes / 2);
  }
  allocate(kLimit_bytes + 1);
}

TEST(AllocationLimit, refuses_aligned_memory) {
  struct alignas(64) Line {
    char bytes[64];
  };
  const AllocationLimit limit(kLimit_bytes);
  EXPECT_EQ(std::vector<Line>(10).size(), 10U);
  EXPECT_THROW(std::vector<Line>(kLimit_bytes / 64), std::bad_alloc);
  operator delete(operator new(10, std::align_val_t(1)), std::align_val_t(1));
  allocate<mrpt::aligned_allocator_cpp11<char>>(1000);
  EXPECT_THROW(allocate<mrpt::aligned_allocator_cpp11<char>>(kLimit_bytes), std::bad_alloc);
}

TEST(AllocationLimit, counts_many_small_allocations) {
  const AllocationLimit limit(kLimit_bytes);
  std::deque<std::array<char, 1000>> parts;
  EXPECT_THROW(while (true) parts.emplace_back(), std::bad_alloc);
  EXPECT_GT(parts.size(), kLimit_bytes / 2000);
  EXPECT_LE(parts.size(), kLimit_bytes / 1000);
}

TEST(AllocationLimit, counts_within_an_outer_limit) {
  const AllocationLimit outer(kLimit_bytes);
  {
    const AllocationLimit larger(2 * kLimit_bytes);
    EXPECT_THROW(allocate(kLimit_bytes + 1), std::bad_alloc);
    const AllocationLimit smaller(kLimit_bytes / 2);
    EXPECT_THROW(allocate(kLimit_bytes / 2 + 1), std::bad_alloc);
    allocate(kLimit_bytes / 2);
  }
  EXPECT_THROW(allocate(kLimit_bytes / 2 + 1), std::bad_alloc);
  allocate(kLimit_bytes / 4);
}

TEST(AllocationLimit, leaves_other_threads_alone) {
  const AllocationLimit limit(kLimit_bytes);
  std::thread([] { allocate(kLimit_bytes + 1); }).join();
}

}  // namespace
}  // namespace psi_slam
