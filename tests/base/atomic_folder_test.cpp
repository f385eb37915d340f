// SPDX-License-Identifier: BSD-3-Clause
#include "base/atomic_folder.h"

#include <gmock/gmock.h>

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

TEST(AtomicFolder, deletes_outdated_files_that_were_not_written) {
  const TemporaryFolder folder;
  for (const char* name : {"map.png", "map.dxf", "notes"}) write_text_atomically(folder.path() / name, "old");
  write_files_atomically(
      folder.path(), [](const fs::path& temporary) { std::ofstream(temporary / "map.png") << "new"; },
      [](const std::string& name) { return name != "notes"; });
  EXPECT_EQ(read_file(folder.path() / "map.png"), "new");
  EXPECT_THAT(names_in(folder.path()), ElementsAre("map.png", "notes"));
}

TEST(AtomicFolder, an_outdated_file_that_cannot_be_deleted_is_an_error) {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "map.dxf");
  try {
    write_files_atomically(
        folder.path(), [](const fs::path&) {}, [](const std::string& name) { return name == "map.dxf"; });
    FAIL() << "no exception";
  } catch (const SystemFailure& failure) {
    EXPECT_THAT(failure.what(), HasSubstr("cannot delete " + (folder.path() / "map.dxf").string() + ": "));
  }
}

TEST(AtomicFolder, only_this_user_can_read_the_temporary_folder) {
  const TemporaryFolder folder;
  write_files_atomically(folder.path(), [](const fs::path& temporary) {
    EXPECT_EQ(fs::status(temporary).permissions(), fs::perms::owner_all);
  });
}

TEST(AtomicFolder, failures_name_the_final_place) {
  const TemporaryFolder folder;
  try {
    write_files_atomically(folder.path(), [](const fs::path& temporary) {
      throw SystemFailure("cannot write " + (temporary / "map.png").string() + ": full");
    });
    FAIL() << "no exception";
  } catch (const SystemFailure& failure) {
    EXPECT_EQ(failure.what(), "cannot write " + (folder.path() / "map.png").string() + ": full");
  }
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
