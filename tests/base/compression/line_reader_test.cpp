// SPDX-License-Identifier: BSD-3-Clause
#include "base/compression/line_reader.h"

#include <gmock/gmock.h>

#include "base/compression/compressed_file.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

class LineReaderTest : public testing::Test {
 protected:
  std::vector<std::string> lines_of(const std::string& text) {
    write_file(path_, text);
    LineReader reader(path_);
    std::vector<std::string> lines;
    std::string_view line;
    while (reader.next(line)) {
      lines.emplace_back(line);
      EXPECT_EQ(reader.line_number(), lines.size());
    }
    last_was_ended_ = reader.line_was_ended();
    return lines;
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "log.clf";
  bool last_was_ended_ = false;
};

TEST_F(LineReaderTest, takes_lines_with_any_line_end) {
  EXPECT_THAT(lines_of("a\nbc\r\n\nd\n"), testing::ElementsAre("a", "bc", "", "d"));
  EXPECT_TRUE(last_was_ended_);
}

TEST_F(LineReaderTest, gives_a_last_line_without_line_end_and_says_so) {
  EXPECT_THAT(lines_of("a\nb"), testing::ElementsAre("a", "b"));
  EXPECT_FALSE(last_was_ended_);
}

TEST_F(LineReaderTest, gives_nothing_of_an_empty_file) {
  EXPECT_TRUE(lines_of("").empty());
}

TEST_F(LineReaderTest, joins_lines_over_the_borders_of_its_buffer) {
  std::vector<std::string> written;
  std::string text;
  for (std::size_t i = 0; i < 60; ++i) {
    written.push_back(std::string(i * 997 * 13 % 400'000, static_cast<char>('a' + i % 26)));
    text += written.back() + "\n";
  }
  EXPECT_EQ(lines_of(text), written);
}

TEST_F(LineReaderTest, reads_text_in_memory_and_what_follows_it) {
  write_file(path_, "nd\nthird\n");
  LineReader reader(std::make_unique<TextSource>(std::make_shared<const std::string>("first\nseco"), "stream",
                                                 std::make_unique<CompressedFile>(path_)));
  std::vector<std::string> lines;
  std::string_view line;
  while (reader.next(line)) lines.emplace_back(line);
  EXPECT_THAT(lines, testing::ElementsAre("first", "second", "third"));
  EXPECT_EQ(reader.place(), "stream:3");
}

TEST_F(LineReaderTest, names_the_place_as_editors_take_it) {
  write_file(path_, "a\nb\n");
  LineReader reader(path_);
  std::string_view line;
  reader.next(line);
  reader.next(line);
  EXPECT_EQ(reader.place(), path_.string() + ":2");
}

TEST_F(LineReaderTest, refuses_what_is_no_text) {
  EXPECT_EQ(sentence_of([&] { lines_of("x\n" + std::string(17 * 1024 * 1024, 'z')); }),
            path_.string() +
                ":2: the line is longer than 16 MB, expected a text file. Check that the file is a log");
}

}  // namespace
}  // namespace psi_slam
