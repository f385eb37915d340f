// SPDX-License-Identifier: BSD-3-Clause
#include "base/atomic_file.h"

#include <gmock/gmock.h>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "psi_slam/user_error.h"
#include "temporary_folder.h"
#include "test_files.h"

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

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& file : fs::directory_iterator(folder)) names.insert(file.path().filename().string());
  return names;
}

TEST(AtomicFolder, moves_all_files_when_all_are_complete) {
  const TemporaryFolder folder;
  write_text_atomically(folder.path() / "map.png", "old");
  write_text_atomically(folder.path() / "other", "kept");
  write_files_atomically(folder.path(), [&](const fs::path& temporary) {
    EXPECT_EQ(temporary.parent_path(), folder.path());
    std::ofstream(temporary / "map.png") << "new";
    std::ofstream(temporary / "map_limits.txt") << "1 2";
    EXPECT_EQ(read_file(folder.path() / "map.png"), "old");
    EXPECT_FALSE(fs::exists(folder.path() / "map_limits.txt"));
  });
  EXPECT_EQ(read_file(folder.path() / "map.png"), "new");
  EXPECT_THAT(names_in(folder.path()), ElementsAre("map.png", "map_limits.txt", "other"));
}

TEST(AtomicFolder, a_failing_writer_changes_nothing_and_leaves_no_temporary_folder) {
  const TemporaryFolder folder;
  write_text_atomically(folder.path() / "map.png", "old");
  EXPECT_THROW(write_files_atomically(folder.path(),
                                      [](const fs::path& temporary) {
                                        std::ofstream(temporary / "map.png") << "half";
                                        throw std::runtime_error("power cut");
                                      }),
               std::runtime_error);
  EXPECT_EQ(read_file(folder.path() / "map.png"), "old");
  EXPECT_THAT(names_in(folder.path()), ElementsAre("map.png"));
}

TEST(AtomicFolder, removes_only_leftovers_of_ended_processes) {
  const TemporaryFolder folder;
  const pid_t dead = fork();
  if (dead == 0) _exit(0);
  ASSERT_EQ(waitpid(dead, nullptr, 0), dead);
  const std::string of_dead = ".partial-" + std::to_string(dead);
  const std::string of_living = ".partial-" + std::to_string(getpid());
  fs::create_directory(folder.path() / of_dead);
  for (const std::string& name : {of_dead + "/map.png", of_dead + "-map.png", of_living + "-map.png",
                                  std::string(".partial-notes"), std::string("map.png")})
    std::ofstream(folder.path() / name) << "half";
  const auto hours_ago = fs::file_time_type::clock::now() - std::chrono::hours(2);
  remove_leftovers(folder.path());
  EXPECT_TRUE(fs::exists(folder.path() / of_dead)) << "its writer may run on another machine";
  for (const auto& entry : fs::directory_iterator(folder.path()))
    fs::last_write_time(entry.path(), hours_ago);
  remove_leftovers(folder.path());
  EXPECT_THAT(names_in(folder.path()), ElementsAre(of_living + "-map.png", ".partial-notes", "map.png"));
}

TEST(AtomicFolder, an_obstacle_is_an_error_with_its_name) {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "map.png" / "full");
  try {
    write_files_atomically(folder.path(),
                           [](const fs::path& temporary) { std::ofstream(temporary / "map.png") << "new"; });
    FAIL() << "no exception";
  } catch (const SystemFailure& failure) {
    EXPECT_THAT(failure.what(), HasSubstr("cannot write " + (folder.path() / "map.png").string() + ": "));
  }
  EXPECT_THROW(write_files_atomically(folder.path() / "missing", [](const fs::path&) {}), SystemFailure);
}

}  // namespace
}  // namespace psi_slam
