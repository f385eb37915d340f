// SPDX-License-Identifier: BSD-3-Clause
// What a full disk does to a file is tested by its users as well.
#include "base/appended_file.h"

#include <gmock/gmock.h>

#include <memory>
#include <string>

#include "full_disk.h"
#include "psi_slam/user_error.h"
#include "soon.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

class AppendedFileTest : public testing::Test {
 protected:
  TemporaryFolder folder_;
  fs::path path_ = folder_.path() / "file";
};

TEST_F(AppendedFileTest, grows_while_it_is_written) {
  AppendedFile file(path_, false);
  EXPECT_EQ(read_file(path_), "");
  EXPECT_TRUE(file.append("one"));
  EXPECT_TRUE(soon([&] { return read_file(path_) == "one"; }));
  EXPECT_TRUE(file.append("two"));
  file.close();
  EXPECT_EQ(read_file(path_), "onetwo");
  EXPECT_EQ(file.failure(), std::nullopt);
}

TEST_F(AppendedFileTest, an_existing_file_is_replaced_only_if_asked) {
  write_file(path_, "before");
  EXPECT_THAT(sentence_of([&] { const AppendedFile file(path_, false); }),
              testing::HasSubstr("exists already"));
  EXPECT_EQ(read_file(path_), "before");
  const AppendedFile file(path_, true);
  EXPECT_EQ(read_file(path_), "");
}

TEST_F(AppendedFileTest, a_folder_that_is_missing_is_a_failure_of_the_system) {
  EXPECT_THROW(AppendedFile(folder_.path() / "none" / "file", false), SystemFailure);
}

TEST_F(AppendedFileTest, refuses_bytes_as_a_whole_when_too_many_wait) {
  const std::string half(AppendedFile::kMostWaitingBytes / 2, 'x');
  AppendedFile file(path_, false);
  {
    const FullDisk full(10);
    EXPECT_TRUE(file.append(half));
    ASSERT_TRUE(soon([&] { return file.failure().has_value(); }));
    EXPECT_TRUE(file.append(half));
    EXPECT_FALSE(file.append("more"));
  }
  ASSERT_TRUE(soon([&] { return !file.failure(); }));
  EXPECT_TRUE(file.append("end"));
  file.close();
  EXPECT_TRUE(read_file(path_) == half + half + "end");
}

TEST_F(AppendedFileTest, closing_tries_once_more) {
  for (const bool has_room : {false, true}) {
    AppendedFile file(path_, true);
    auto full = std::make_unique<FullDisk>(3);
    EXPECT_TRUE(file.append("bytes"));
    ASSERT_TRUE(soon([&] { return file.failure().has_value(); }));
    if (has_room) full.reset();
    file.close();
    full.reset();
    EXPECT_EQ(file.failure().has_value(), !has_room);
    EXPECT_EQ(read_file(path_), has_room ? "bytes" : "byt");
  }
}

}  // namespace
}  // namespace psi_slam
