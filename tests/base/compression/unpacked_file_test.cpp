// SPDX-License-Identifier: BSD-3-Clause
#include "base/compression/unpacked_file.h"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdlib>
#include <optional>
#include <random>
#include <string>

#include "decompression_bombs.h"
#include "temporary_folder.h"
#include "test_files.h"
#include "zstd_files.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

class UnpackedFileTest : public testing::Test {
 protected:
  void SetUp() override {
    if (const char* stated = std::getenv("TMPDIR")) before_ = stated;
    fs::create_directory(temporary_);
    setenv("TMPDIR", temporary_.c_str(), 1);
    std::mt19937 random(5);
    for (char& byte : bytes_) byte = static_cast<char>(random() & 0xFFU);
    write_file(path_, zstd_frame(bytes_, 100'000));
  }

  void TearDown() override { before_ ? setenv("TMPDIR", before_->c_str(), 1) : unsetenv("TMPDIR"); }

  static std::string read(UnpackedFile& file, std::uint64_t offset, std::size_t size) {
    std::string bytes(size, '\0');
    bytes.resize(file.read(offset, bytes.data(), size));
    return bytes;
  }

  TemporaryFolder folder_;
  fs::path path_ = folder_.path() / "run.db3.zstd";
  fs::path temporary_ = folder_.path() / "temporary";
  std::string bytes_ = std::string(3'000'000, '\0');
  std::optional<std::string> before_;
};

TEST_F(UnpackedFileTest, reads_any_bytes_in_any_order) {
  UnpackedFile file(path_);
  for (const std::size_t offset : {5'000U, 1'700'000U, 0U, 1'000'001U, 2'999'000U, 999U})
    EXPECT_TRUE(read(file, offset, 1000) == bytes_.substr(offset, 1000)) << offset;
  EXPECT_TRUE(read(file, 2'999'900, 1000) == bytes_.substr(2'999'900));
  EXPECT_EQ(read(file, 5'000'000'000'000, 10), "");
}

TEST_F(UnpackedFileTest, refuses_to_fill_the_disk) {
  write_file(path_, frame_of_zeros(3'000'000'000));
  UnpackedFile file(path_);
  EXPECT_EQ(read(file, 1'000'000, 10), std::string(10, '\0'));
  EXPECT_THAT(
      sentence_of([&] { file.unpack_rest(); }),
      testing::HasSubstr("run.db3.zstd unpacks to more than 268435456 bytes, which no recording of its "
                         "size does. Fetch it again"));
}

TEST_F(UnpackedFileTest, unpacks_no_more_than_is_needed) {
  UnpackedFile file(path_);
  read(file, 0, 100);
  EXPECT_LT(file.progress(), 0.2);
  read(file, 1'500'000, 100);
  EXPECT_NEAR(file.progress(), 0.5, 0.15);
  file.unpack_rest();
  EXPECT_EQ(file.progress(), 1.0);
}

TEST_F(UnpackedFileTest, the_temporary_file_has_no_name_so_that_it_never_stays) {
  UnpackedFile file(path_);
  read(file, 1'000'000, 100);
  EXPECT_TRUE(fs::is_empty(temporary_));
}

TEST_F(UnpackedFileTest, reads_up_to_a_truncation) {
  fs::resize_file(path_, fs::file_size(path_) / 2);
  UnpackedFile file(path_);
  const std::string sentence =
      path_.string() + " is cut off: its compressed data are incomplete. Fetch it again";
  EXPECT_EQ(sentence_of([&] { read(file, 2'000'000, 10); }), sentence);
  EXPECT_TRUE(read(file, 1'300'000, 1000) == bytes_.substr(1'300'000, 1000));
  EXPECT_EQ(sentence_of([&] { file.unpack_rest(); }), sentence);
}

TEST_F(UnpackedFileTest, names_the_folder_that_has_no_space) {
  struct rlimit before {};
  getrlimit(RLIMIT_FSIZE, &before);
  struct rlimit limit = before;
  limit.rlim_cur = 1'000'000;
  const auto signal_before = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &limit);
  UnpackedFile file(path_);
  const std::string sentence = sentence_of([&] { read(file, 2'000'000, 10); });
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, signal_before);
  EXPECT_EQ(sentence, "cannot unpack " + path_.string() + " into a temporary file in " + temporary_.string() +
                          ": File too large. Free space there, or set TMPDIR to a folder with more space");
}

TEST_F(UnpackedFileTest, names_a_missing_folder) {
  setenv("TMPDIR", "/nowhere", 1);
  EXPECT_THAT(sentence_of([&] { UnpackedFile{path_}; }),
              testing::HasSubstr("into a temporary file in /nowhere: No such file or directory. "));
}

}  // namespace
}  // namespace psi_slam
