// SPDX-License-Identifier: BSD-3-Clause
#include "base/compression/packed_bytes.h"

#include <gtest/gtest.h>

#include <random>

namespace psi_slam {
namespace {

using Bytes = std::vector<std::uint8_t>;

TEST(PackedBytes, come_back_as_they_were) {
  std::mt19937 random(1);
  Bytes noise(100'000);
  for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(random());
  for (const Bytes& bytes : {Bytes(), Bytes{7}, Bytes(1'000'000, 0), noise}) {
    const PackedBytes packed(bytes);
    EXPECT_EQ(packed.size(), bytes.size());
    EXPECT_EQ(packed.unpacked(), bytes);
    EXPECT_EQ(packed.unpacked(), bytes) << "bytes can be unpacked more than once";
  }
  EXPECT_EQ(PackedBytes().unpacked(), Bytes());
}

TEST(PackedBytes, need_little_memory_where_little_is_in_them) {
  Bytes walls(1'000'000, 0);
  for (std::size_t i = 0; i < walls.size(); i += 100) walls[i] = 200;
  EXPECT_LT(PackedBytes(walls).memory_bytes(), walls.size() / 50);
}

}  // namespace
}  // namespace psi_slam
