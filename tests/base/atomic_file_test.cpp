// SPDX-License-Identifier: BSD-3-Clause
#include "base/atomic_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "psi_slam/user_error.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

std::string contents(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::ptrdiff_t files_in(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

TEST(AtomicFile, replaces_the_old_file_by_the_whole_new_one) {
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

TEST(AtomicFile, a_failing_writer_leaves_the_old_file_and_no_rubbish) {
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

TEST(AtomicFile, a_full_disk_is_said_in_a_sentence) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  const TemporaryFolder folder;
  try {
    write_atomically(folder.path() / "map.pgm", [](const fs::path& temporary) {
      fs::create_symlink("/dev/full", temporary);
      write_text_atomically(temporary.parent_path() / "missing" / "x", "y");
    });
    FAIL() << "no exception";
  } catch (const SystemFailure& failure) {
    EXPECT_NE(std::string(failure.what()).find("cannot write"), std::string::npos);
  }
  EXPECT_EQ(files_in(folder.path()), 0);
}

}  // namespace
}  // namespace psi_slam
