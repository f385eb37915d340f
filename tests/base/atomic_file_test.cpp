// SPDX-License-Identifier: BSD-3-Clause
#include "base/atomic_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>
#include <csignal>
#include <fstream>
#include <iterator>
#include <string>

#include "psi_slam/user_error.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

std::string contents(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::ptrdiff_t files_in(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

TEST(AtomicFile, replaces_the_old_file_by_the_complete_new_one) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "map.yaml";
  write_text_atomically(path, "old");
  write_text_atomically(path, "new\n");
  EXPECT_EQ(contents(path), "new\n");
  EXPECT_EQ(files_in(folder.path()), 1);
}

TEST(AtomicFile, keeps_the_extension_so_that_writers_can_choose_by_it) {
  const TemporaryFolder folder;
  write_atomically(folder.path() / "map.gridmap.gz", [&](const fs::path& temporary) {
    EXPECT_EQ(temporary.parent_path(), folder.path());
    EXPECT_EQ(temporary.extension(), ".gz");
    std::ofstream(temporary) << "x";
  });
  EXPECT_EQ(contents(folder.path() / "map.gridmap.gz"), "x");
}

TEST(AtomicFile, a_failing_writer_keeps_the_old_file_and_leaves_no_temporary_file) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "graph.g2o";
  write_text_atomically(path, "old");
  EXPECT_THROW(write_atomically(path,
                                [](const fs::path& temporary) {
                                  std::ofstream(temporary) << "half";
                                  throw std::runtime_error("power cut");
                                }),
               std::runtime_error);
  EXPECT_EQ(contents(path), "old");
  EXPECT_EQ(files_in(folder.path()), 1);
}

// A limit on the file size makes writes fail, like a full disk.
TEST(AtomicFile, a_failing_write_is_an_error_with_the_file_name) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "map.pgm";
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit small = before;
  small.rlim_cur = 4096;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  std::string message;
  try {
    write_text_atomically(path, std::string(1 << 20, 'x'));
  } catch (const SystemFailure& failure) {
    message = failure.what();
  }
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(message.find("cannot write"), std::string::npos) << message;
  EXPECT_NE(message.find(path.string()), std::string::npos) << message;
  EXPECT_EQ(files_in(folder.path()), 0);
}

TEST(AtomicFile, a_temporary_name_is_never_used_twice) {
  const TemporaryFolder folder;
  const AtomicFile a(folder.path() / "map.png");
  const AtomicFile b(folder.path() / "map.png");
  EXPECT_NE(a.temporary_path(), b.temporary_path());
}

TEST(AtomicFile, replaces_a_symbolic_link_and_keeps_the_file_that_it_points_to) {
  const TemporaryFolder folder;
  write_text_atomically(folder.path() / "other", "kept");
  fs::create_symlink("other", folder.path() / "map.yaml");
  write_text_atomically(folder.path() / "map.yaml", "new");
  EXPECT_EQ(contents(folder.path() / "other"), "kept");
  EXPECT_FALSE(fs::is_symlink(folder.path() / "map.yaml"));
  EXPECT_EQ(contents(folder.path() / "map.yaml"), "new");
}

TEST(AtomicFile, a_file_that_is_not_moved_leaves_nothing) {
  const TemporaryFolder folder;
  write_text_atomically(folder.path() / "map.yaml", "old");
  {
    AtomicFile file(folder.path() / "map.yaml");
    file.write("half");
  }
  EXPECT_EQ(contents(folder.path() / "map.yaml"), "old");
  EXPECT_EQ(files_in(folder.path()), 1);
}

TEST(AtomicFile, the_returned_descriptor_is_that_of_the_file) {
  const TemporaryFolder folder;
  AtomicFile file(folder.path() / "my.journal");
  file.write("a");
  const Descriptor descriptor = file.move_into_place();
  ASSERT_EQ(::write(descriptor.number(), "b", 1), 1);
  EXPECT_EQ(contents(folder.path() / "my.journal"), "ab");
}

TEST(AtomicFile, a_missing_folder_is_an_error_that_says_what_to_do) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "missing" / "map.yaml";
  try {
    write_text_atomically(path, "x");
    FAIL() << "no exception";
  } catch (const SystemFailure& failure) {
    EXPECT_EQ(failure.what(), "cannot write " + path.string() +
                                  ": No such file or directory. Choose a folder that exists and is writable");
  }
}

TEST(AtomicFile, a_long_name_has_a_temporary_name_that_ends_like_it) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / (std::string(245, 'm') + ".png");
  write_atomically(path, [](const fs::path& temporary) {
    EXPECT_EQ(temporary.extension(), ".png");
    std::ofstream(temporary) << "x";
  });
  EXPECT_EQ(contents(path), "x");
}

}  // namespace
}  // namespace psi_slam
