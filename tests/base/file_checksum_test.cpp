// SPDX-License-Identifier: BSD-3-Clause
#include "base/file_checksum.h"

#include <gtest/gtest.h>

#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

TEST(FileChecksum, equals_the_examples_of_the_standard) {
  EXPECT_EQ(sha256_of_text("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_of_text(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST(FileChecksum, of_a_file_equals_that_of_its_bytes) {
  const TemporaryFolder folder;
  const std::string bytes(200'001, '\0');  // longer than the block that is read at once
  write_file(folder.path() / "zeros", bytes);
  EXPECT_EQ(sha256_of_file(folder.path() / "zeros"), sha256_of_text(bytes));
  EXPECT_NE(sha256_of_text(bytes), sha256_of_text(bytes + '\0'));
  EXPECT_NE(sentence_of([&] { sha256_of_file(folder.path() / "none"); }).find("none"), std::string::npos);
  EXPECT_NE(sentence_of([&] { sha256_of_file(folder.path()); }).find("is not readable"), std::string::npos);
}

TEST(FileChecksum, of_a_folder_depends_on_its_files_and_their_names) {
  const TemporaryFolder folder;
  write_file(folder.path() / "b", "2");
  write_file(folder.path() / "a", "1");
  EXPECT_EQ(sha256_of_log(folder.path()),
            sha256_of_text("a " + sha256_of_text("1") + "\nb " + sha256_of_text("2") + "\n"));
  EXPECT_EQ(sha256_of_log(folder.path() / "a"), sha256_of_text("1"));
}

}  // namespace
}  // namespace psi_slam
