// SPDX-License-Identifier: BSD-3-Clause
#include "rival_program.h"

#include <gmock/gmock.h>

#include "rival_files.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(RivalProgram, is_found_on_the_search_path_with_its_settings_beside_it) {
  const TemporaryFolder folder;
  install_rival(folder.path() / "usr", rival_kinds()[0], "");
  fs::create_directory_symlink(folder.path() / "usr/bin", folder.path() / "bin");
  const FoundRivals found = find_rivals("/no/such/folder:" + (folder.path() / "bin").string());
  ASSERT_EQ(found.programs.size(), 1U);
  const RivalProgram& rival = found.programs[0];
  EXPECT_EQ(rival.kind.name, "icp-slam");
  EXPECT_EQ(rival.program, fs::canonical(folder.path()) / "usr/bin/icp-slam");
  EXPECT_EQ(rival.version, "MRPT 9.9.9 - Sources");
  EXPECT_EQ(rival.sha256.size(), 64U);
  EXPECT_THAT(found.missing, testing::ElementsAre("rbpf-slam is not on PATH"));
}

TEST(RivalProgram, without_settings_or_program_is_missing) {
  const TemporaryFolder folder;
  EXPECT_EQ(rivals_in(folder.path()).missing.size(), rival_kinds().size());
  install_rival(folder.path(), rival_kinds()[0], "");
  fs::remove_all(folder.path() / "share");
  const FoundRivals found = rivals_in(folder.path());
  EXPECT_TRUE(found.programs.empty());
  EXPECT_THAT(found.missing.at(0),
              AllOf(HasSubstr("has no settings"), HasSubstr("icp-slam_demo_classic.ini")));
}

TEST(RivalProgram, keeps_its_settings_but_for_what_is_set_otherwise) {
  const TemporaryFolder folder;
  install_rival(folder.path(), rival_kinds()[0], "");
  const std::string settings = rival_settings(rivals_in(folder.path()).programs.at(0), "/some/where");
  EXPECT_THAT(settings,
              AllOf(HasSubstr("ALFA"), HasSubstr("/some/where"), Not(HasSubstr("LOG // a remark"))));
  EXPECT_THAT(settings, testing::ContainsRegex("SAVE_3D_SCENE *= *0"));
  EXPECT_THAT(changes_text(rival_kinds()[1]), HasSubstr("RANDOM_SEED = 1"));
}

}  // namespace
}  // namespace psi_slam
