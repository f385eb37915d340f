// SPDX-License-Identifier: BSD-3-Clause
#include "base/compression/compression.h"

#include <gtest/gtest.h>

#include <string>

namespace psi_slam {
namespace {

TEST(CompressionTest, zstd_gives_the_bytes_back) {
  for (const std::string& bytes : {std::string(), std::string("psi"), std::string(3'000'000, 'x')}) {
    const std::string packed = zstd_compressed(bytes);
    EXPECT_LT(packed.size(), 1'000U);
    EXPECT_EQ(decompress("zstd", packed, bytes.size()), bytes);
  }
}

TEST(CompressionTest, crc32_has_the_check_value_of_its_standard) {
  EXPECT_EQ(crc32_of("123456789"), 0xCBF43926U);
  EXPECT_EQ(crc32_of(""), 0U);
}

}  // namespace
}  // namespace psi_slam
