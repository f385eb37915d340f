// SPDX-License-Identifier: BSD-3-Clause
#include "base/partial_files.h"

#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <set>
#include <string>

#include "temporary_folder.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using ::testing::MatchesRegex;
using ::testing::UnorderedElementsAre;

TEST(PartialFiles, names_are_hidden_and_differ_each_time) {
  const std::string own = "\\.partial-" + std::to_string(getpid()) + "-[0-9a-f]+";
  EXPECT_THAT(new_partial_name(), MatchesRegex(own));
  EXPECT_THAT(new_partial_name("map.png"), MatchesRegex(own + "-map\\.png"));
  std::set<std::string> names;
  for (int i = 0; i < 1000; ++i) names.insert(new_partial_name());
  EXPECT_EQ(names.size(), 1000U);
}

TEST(PartialFiles, recognises_its_names) {
  EXPECT_TRUE(is_partial_name(new_partial_name()));
  EXPECT_TRUE(is_partial_name(new_partial_name("map.png")));
  for (const char* name : {"map.png", ".partial-", ".partial-notes", ".partial-12notes"})
    EXPECT_FALSE(is_partial_name(name)) << name;
}

TEST(PartialFiles, removes_only_leftovers_of_ended_processes) {
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
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder.path())) names.insert(entry.path().filename());
  EXPECT_THAT(names, UnorderedElementsAre(of_living + "-map.png", ".partial-notes", "map.png"));
}

}  // namespace
}  // namespace psi_slam
