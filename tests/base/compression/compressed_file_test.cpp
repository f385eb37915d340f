// SPDX-License-Identifier: BSD-3-Clause
#include "base/compression/compressed_file.h"

#include <random>

#include "base/byte_cursor.h"
#include "base/compression/compression.h"
#include "packed_files.h"
#include "temporary_folder.h"
#include "test_files.h"
#include "zstd_files.h"

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

TEST(CompressedFile, reads_files_of_one_or_several_zstd_frames) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "log";
  const std::string bytes = noise(1'000'003) + std::string(3'000'000, 'a');
  write_file(path, zstd_frame(bytes));
  EXPECT_TRUE(content_of(path) == bytes);
  write_file(path, zstd_frame(bytes, 12'345) + zstd_frame("") + zstd_frame("the end"));
  EXPECT_TRUE(content_of(path) == bytes + "the end");
  write_file(path, zstd_frame(""));
  EXPECT_EQ(content_of(path), "");
}

class EachCompression : public testing::TestWithParam<const char*> {};

TEST_P(EachCompression, is_read_in_one_or_several_parts_up_to_a_truncation) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "log";
  const std::string bytes = noise(3'000'003) + std::string(3'000'000, 'a');
  const std::string whole = packed_as(GetParam(), bytes);
  write_file(path, whole);
  EXPECT_TRUE(content_of(path) == bytes);
  write_file(path, whole + packed_as(GetParam(), "") + packed_as(GetParam(), "the end"));
  EXPECT_TRUE(content_of(path) == bytes + "the end");

  write_file(path, whole.substr(0, whole.size() / 2));
  CompressedFile file(path);
  std::string part(bytes.size(), '\0');
  const std::size_t got = file.read(part.data(), part.size());
  EXPECT_GT(got, 500'000U);
  EXPECT_TRUE(part.substr(0, got) == bytes.substr(0, got));
  EXPECT_EQ(sentence_of([&] { file.read(part.data(), part.size()); }),
            path.string() + " is cut off: its compressed data are incomplete. Fetch it again");

  std::string damaged = whole;
  for (std::size_t i = 0; i < 100; ++i) damaged[whole.size() / 3 + i] = '\x55';
  write_file(path, damaged);
  EXPECT_EQ(sentence_of([&] { content_of(path); }),
            path.string() + " is damaged: its data cannot be decompressed. Fetch it again");
}

INSTANTIATE_TEST_SUITE_P(All, EachCompression, testing::Values("bz2", "lz4", "xz", "zstd"));

TEST(CompressedFile, yields_all_but_a_block_of_lz4_before_damage) {
  constexpr std::size_t kBlock = 65'536;
  const TemporaryFolder folder;
  const std::string bytes = noise(20 * kBlock);
  std::string packed = packed_as("lz4", bytes);
  const std::size_t block = packed.find(bytes.substr(11 * kBlock, 20)) - 4;  // noise is stored as it is
  write_file(folder.path() / "log", packed.replace(block, 4, "\xFF\xFF\xFF\x7F"));
  CompressedFile file(folder.path() / "log");
  std::string part(bytes.size(), '\0');
  const std::size_t got = file.read(part.data(), part.size());
  EXPECT_GE(got, 10 * kBlock);
  EXPECT_TRUE(part.substr(0, got) == bytes.substr(0, got));
}

TEST(CompressedFile, reads_padded_streams_of_xz) {
  const TemporaryFolder folder;
  const std::string padding(400'000, '\0');
  write_file(folder.path() / "log", packed_as("xz", "begin ") + padding + packed_as("xz", "end") + padding);
  EXPECT_EQ(content_of(folder.path() / "log"), "begin end");
}

TEST(CompressedFile, says_that_xz_needs_too_much_memory) {
  const TemporaryFolder folder;
  std::string packed = packed_as("xz", "some text");
  constexpr std::size_t kHeader = 12;  // offset of the header of the block, after that of the stream
  const std::size_t size = 4 * (static_cast<std::size_t>(packed.at(kHeader)) + 1);
  packed.at(packed.find("\x21\x01", kHeader) + 2) = 32;  // dictionary of 256 MiB
  const std::uint32_t checksum =
      lzma_crc32(reinterpret_cast<const std::uint8_t*>(packed.data()) + kHeader, size - 4, 0);
  packed.replace(kHeader + size - 4, 4, reinterpret_cast<const char*>(&checksum), 4);
  write_file(folder.path() / "log", packed);
  EXPECT_EQ(sentence_of([&] { content_of(folder.path() / "log"); }),
            (folder.path() / "log").string() +
                " needs more than 128 MiB of memory for decompression. Decompress it with xz first");
}

TEST(CompressedMessage, may_have_a_window_of_64_MiB) {
  const auto frame = [](char window) {
    return std::string("\x28\xB5\x2F\xFD\0", 5) + window + std::string("\x29\0\0hello", 8);
  };
  EXPECT_EQ(decompress("zstd", frame('\x80'), 5), "hello");
  EXPECT_THROW(decompress("zstd", frame('\x88'), 5), MalformedBytes);
}

TEST(CompressedFile, reports_its_progress) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "log";
  const std::string bytes = noise(4'000'000);
  for (const bool zstd : {false, true}) {
    zstd ? write_file(path, zstd_frame(bytes)) : write_gzipped(path, bytes);
    CompressedFile file(path);
    EXPECT_LT(file.progress(), 0.1);
    std::string half(2'000'000, '\0');
    file.read(half.data(), half.size());
    EXPECT_NEAR(file.progress(), 0.5, 0.15);
  }
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

TEST(CompressedFile, yields_every_zstd_block_before_a_truncation_or_damage) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "log.zstd";
  const std::string bytes = noise(100'000);
  const std::string whole = zstd_frame(bytes, 1000);
  const auto expect = [&](const std::string& compressed, const std::string& sentence) {
    write_file(path, compressed);
    CompressedFile file(path);
    std::string part(bytes.size(), '\0');
    const std::size_t got = file.read(part.data(), part.size());
    EXPECT_GE(got, 49'000U);
    EXPECT_LE(got, 50'000U);
    EXPECT_TRUE(part.substr(0, got) == bytes.substr(0, got));
    for (int again = 0; again < 2; ++again)
      EXPECT_EQ(sentence_of([&] { file.read(part.data(), part.size()); }), path.string() + sentence);
  };
  expect(whole.substr(0, whole.size() / 2),
         " is cut off: its compressed data are incomplete. Fetch it again");
  const std::string no_block = "\xFF\xFF\xFF";
  const std::size_t block = whole.find(bytes.substr(50'000, 20)) - 3;  // noise is stored as it is
  expect(std::string(whole).replace(block, 3, no_block),
         " is damaged: its data cannot be decompressed. Fetch it again");
}

TEST(CompressedFile, does_not_believe_a_stated_size_of_terabytes) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "log.zstd";
  const std::string four_terabytes("\0\0\0\0\0\x04\0\0", 8);
  const std::string block("\x28\0\0hello", 8);
  const std::string magic = "\x28\xB5\x2F\xFD";
  write_file(path, magic + "\xC0\x38" + four_terabytes + block);
  std::string part(100, '\0');
  EXPECT_EQ(CompressedFile(path).read(part.data(), part.size()), 5U);
  write_file(path, magic + "\xE0" + four_terabytes + block);  // all of it in one window
  EXPECT_EQ(sentence_of([&] { content_of(path); }),
            path.string() + " is damaged: its data cannot be decompressed. Fetch it again");
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

TEST(CompressedFile, reports_a_file_that_becomes_shorter_while_it_is_read) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "log";
  write_file(path, std::string(2'000'000, 'x'));
  CompressedFile file(path);
  std::string part(1000, '\0');
  EXPECT_EQ(file.read(part.data(), part.size()), part.size());
  std::filesystem::resize_file(path, 1'000'000);
  std::string rest(2'000'000, '\0');
  EXPECT_LE(file.read(rest.data(), rest.size()), 1'000'000U);
  EXPECT_EQ(
      sentence_of([&] { file.read(rest.data(), rest.size()); }),
      path.string() + " became shorter while it was read, expected a file that is complete. Fetch it again");
}

TEST(CompressedFile, reads_a_file_that_grows_or_is_replaced_while_it_is_read) {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "log";
  write_file(path, "first");
  CompressedFile file(path);
  write_file(folder.path() / "other", "x");
  std::filesystem::rename(folder.path() / "other", path);
  std::string part(1000, '\0');
  EXPECT_EQ(file.read(part.data(), part.size()), 5U);
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
