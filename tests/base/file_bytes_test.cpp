// SPDX-License-Identifier: BSD-3-Clause
#include "base/file_bytes.h"

#include <gtest/gtest.h>

#include <fstream>
#include <system_error>

#include "temporary_folder.h"

namespace psi_slam {
namespace {

std::errc why_unreadable(const std::filesystem::path& path) {
  try {
    file_bytes(path);
  } catch (const std::system_error& error) {
    return static_cast<std::errc>(error.code().value());
  }
  return {};
}

TEST(FileBytes, returns_all_bytes) {
  const TemporaryFolder folder;
  for (const std::size_t size : {0U, 1U, 1U << 18, (1U << 18) + 1, 1U << 20}) {
    std::string bytes(size, 'x');
    for (std::size_t i = 0; i < size; i += 1000) bytes[i] = static_cast<char>(i / 1000);
    std::ofstream(folder.path() / "file", std::ios::binary) << bytes;
    EXPECT_TRUE(file_bytes(folder.path() / "file") == bytes) << size;
  }
}

TEST(FileBytes, stops_beyond_the_largest_size) {
  const std::size_t size = file_bytes("/dev/zero", 1'000'000).size();
  EXPECT_GT(size, 1'000'000U);
  EXPECT_LT(size, 2'000'000U);
}

TEST(FileBytes, says_why_a_file_is_unreadable) {
  const TemporaryFolder folder;
  EXPECT_EQ(why_unreadable(folder.path() / "missing"), std::errc::no_such_file_or_directory);
  EXPECT_EQ(why_unreadable(folder.path()), std::errc::is_a_directory) << "the first read fails";
}

}  // namespace
}  // namespace psi_slam
