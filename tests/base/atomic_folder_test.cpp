// SPDX-License-Identifier: BSD-3-Clause
#include "base/atomic_folder.h"

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <set>
#include <string>

#include "base/atomic_file.h"
#include "psi_slam/user_error.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& file : fs::directory_iterator(folder)) names.insert(file.path().filename().string());
  return names;
}

TEST(AtomicFolder, moves_all_files_in_when_all_are_whole) {
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

TEST(AtomicFolder, a_failing_writer_changes_nothing_and_leaves_no_rubbish) {
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

TEST(AtomicFolder, what_a_killed_process_left_is_removed_and_nothing_else) {
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
  EXPECT_TRUE(fs::exists(folder.path() / of_dead)) << "a process of another machine may have that number";
  for (const auto& entry : fs::directory_iterator(folder.path()))
    fs::last_write_time(entry.path(), hours_ago);
  remove_leftovers(folder.path());
  EXPECT_THAT(names_in(folder.path()), ElementsAre(of_living + "-map.png", ".partial-notes", "map.png"));
}

TEST(AtomicFolder, what_is_in_the_way_is_told_in_a_sentence) {
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
