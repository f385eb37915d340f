// SPDX-License-Identifier: BSD-3-Clause
#include "base/compression/growing_file.h"

#include <gmock/gmock.h>
#include <zlib.h>

#include <array>
#include <fstream>
#include <string>

#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;

/// Returns all bytes that the file has now.
std::string read_now(GrowingFile& file) {
  std::string bytes;
  std::array<char, 7> room{};
  while (const std::size_t got = file.read(room.data(), room.size())) bytes.append(room.data(), got);
  return bytes;
}

std::string gzipped(const std::string& text) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "text.gz";
  const gzFile file = gzopen(path.c_str(), "wb");
  gzwrite(file, text.data(), static_cast<unsigned>(text.size()));
  gzclose(file);
  return read_file(path);
}

TEST(GrowingFile, gives_the_bytes_that_were_appended) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "log";
  write_file(path, "");
  GrowingFile file(path);
  std::ofstream recorder(path, std::ios::app);
  EXPECT_EQ(read_now(file), "");
  for (const char* const piece : {"the first line\n", "the se", "cond line\n", ""}) {
    recorder << piece << std::flush;
    EXPECT_EQ(read_now(file), piece);
  }
}

TEST(GrowingFile, decompresses_what_is_complete) {
  std::string text;
  for (int i = 0; i < 3000; ++i) text += "line " + std::to_string(i * i) + '\n';
  const std::string bytes = gzipped(text);
  const TemporaryFolder folder;
  const auto path = folder.path() / "log.gz";
  write_file(path, "");
  GrowingFile file(path);
  std::ofstream recorder(path, std::ios::app | std::ios::binary);
  std::string read;
  constexpr std::size_t kPieces = 10;
  for (std::size_t i = 0; i < kPieces; ++i) {
    const std::size_t begin = bytes.size() * i / kPieces;
    recorder << bytes.substr(begin, bytes.size() * (i + 1) / kPieces - begin) << std::flush;
    read += read_now(file);
    EXPECT_EQ(read, text.substr(0, read.size()));
    if (i + 1 == kPieces / 2) {
      EXPECT_GT(read.size(), text.size() / 10) << "before the file is complete";
    }
  }
  EXPECT_EQ(read, text);
}

TEST(GrowingFile, must_not_shrink) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "my.log";
  write_file(path, "one\n");
  GrowingFile file(path);
  EXPECT_EQ(read_now(file), "one\n");
  write_file(path, "");
  EXPECT_THAT(sentence_of([&] { read_now(file); }), HasSubstr("my.log became shorter while it was followed"));
}

TEST(GrowingFile, must_not_shrink_while_it_is_read) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "my.log";
  write_file(path, std::string(1'000'000, 'a'));
  GrowingFile file(path);
  std::array<char, 7> room{};
  EXPECT_EQ(file.read(room.data(), room.size()), room.size());
  write_file(path, "");
  EXPECT_THAT(sentence_of([&] { read_now(file); }), HasSubstr("my.log became shorter"));
}

TEST(GrowingFile, says_what_cannot_be_read) {
  const TemporaryFolder folder;
  EXPECT_THAT(sentence_of([&] { GrowingFile(folder.path() / "none"); }), HasSubstr("cannot read"));
  const auto path = folder.path() / "damaged.gz";
  std::string bytes = gzipped(std::string(5000, 'a') + "the end");
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] + 77);
  write_file(path, bytes);
  GrowingFile damaged(path);
  EXPECT_THAT(sentence_of([&] { read_now(damaged); }), HasSubstr("damaged.gz is damaged"));
}

}  // namespace
}  // namespace psi_slam
