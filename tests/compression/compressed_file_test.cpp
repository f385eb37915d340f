// SPDX-License-Identifier: BSD-3-Clause
#include "compression/compressed_file.h"

#include <random>

#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

std::string noise(std::size_t size) {
  std::mt19937 random(3);
  std::string bytes(size, '\0');
  for (char& byte : bytes) byte = static_cast<char>(random() & 0xFFU);
  return bytes;
}

std::string content_of(const std::filesystem::path& path) {
  CompressedFile file(path);
  std::string content;
  std::string part(1000, '\0');
  while (const std::size_t got = file.read(part.data(), part.size())) content.append(part, 0, got);
  EXPECT_EQ(file.progress(), 1.0);
  return content;
}

TEST(CompressedFile, reads_plain_and_gzipped_files_of_any_name) {
  const TemporaryFolder folder;
  const std::string bytes = noise(1'000'003);
  write_file(folder.path() / "plain.gz", bytes);
  write_gzipped(folder.path() / "zipped.txt", bytes);
  EXPECT_TRUE(content_of(folder.path() / "plain.gz") == bytes);
  EXPECT_TRUE(content_of(folder.path() / "zipped.txt") == bytes);
}

TEST(CompressedFile, reports_its_progress) {
  const TemporaryFolder folder;
  write_gzipped(folder.path() / "log", noise(4'000'000));
  CompressedFile file(folder.path() / "log");
  EXPECT_LT(file.progress(), 0.1);
  std::string half(2'000'000, '\0');
  file.read(half.data(), half.size());
  EXPECT_NEAR(file.progress(), 0.5, 0.15);
}

TEST(CompressedFile, reports_truncated_data) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "log.gz";
  write_gzipped(path, noise(100'000));
  std::filesystem::resize_file(path, 50'000);
  EXPECT_EQ(sentence_of([&] { content_of(path); }),
            path.string() + " is cut off: its compressed data are incomplete. Fetch it again");
}

TEST(CompressedFile, yields_the_data_before_the_truncation) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "log.gz";
  const std::string bytes = noise(100'000);
  write_gzipped(path, bytes);
  std::filesystem::resize_file(path, 50'000);
  CompressedFile file(path);
  std::string part(bytes.size(), '\0');
  const std::size_t got = file.read(part.data(), part.size());
  EXPECT_GT(got, 10'000U);
  EXPECT_TRUE(part.substr(0, got) == bytes.substr(0, got));
  for (int again = 0; again < 2; ++again)
    EXPECT_EQ(sentence_of([&] { file.read(part.data(), part.size()); }),
              path.string() + " is cut off: its compressed data are incomplete. Fetch it again");
}

TEST(CompressedFile, reports_damaged_data) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "log.gz";
  write_gzipped(path, noise(100'000));
  std::string bytes = read_file(path);
  bytes[60'000] = static_cast<char>(bytes[60'000] ^ 0x55);
  write_file(path, bytes);
  EXPECT_EQ(sentence_of([&] { content_of(path); }),
            path.string() + " is damaged: its data cannot be decompressed. Fetch it again");
}

TEST(CompressedFile, reports_missing_files_and_folders) {
  const TemporaryFolder folder;
  EXPECT_EQ(sentence_of([&] { CompressedFile{folder.path()}; }),
            folder.path().string() + " is a folder, expected a log file. Name a file");
  EXPECT_EQ(sentence_of([&] { CompressedFile{folder.path() / "no"}; }),
            (folder.path() / "no").string() + " does not exist, expected a log file. Check the path");
}

}  // namespace
}  // namespace psi_slam
