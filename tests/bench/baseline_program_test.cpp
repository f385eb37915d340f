// SPDX-License-Identifier: BSD-3-Clause
#include "freiburg/baselines.h"

#include <gmock/gmock.h>

#include "baseline_files.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(BaselineProgram, is_found_on_the_search_path_with_its_settings) {
  const TemporaryFolder folder;
  install_baseline(folder.path() / "usr", baseline_kinds()[0], "");
  fs::create_directory_symlink(folder.path() / "usr/bin", folder.path() / "bin");
  const FoundBaselines found = find_baselines("/no/such/folder:" + (folder.path() / "bin").string());
  ASSERT_EQ(found.programs.size(), 1U);
  const BaselineProgram& baseline = found.programs[0];
  EXPECT_EQ(baseline.kind.name, "icp-slam");
  EXPECT_EQ(baseline.program, fs::canonical(folder.path()) / "usr/bin/icp-slam");
  EXPECT_EQ(baseline.version, "MRPT 9.9.9 - Sources");
  EXPECT_EQ(baseline.sha256.size(), 64U);
  EXPECT_THAT(found.missing, testing::ElementsAre("rbpf-slam is not on PATH"));
}

TEST(BaselineProgram, is_missing_without_program_or_settings) {
  const TemporaryFolder folder;
  EXPECT_EQ(baselines_in(folder.path()).missing.size(), baseline_kinds().size());
  install_baseline(folder.path(), baseline_kinds()[0], "");
  fs::remove_all(folder.path() / "share");
  const FoundBaselines found = baselines_in(folder.path());
  EXPECT_TRUE(found.programs.empty());
  EXPECT_THAT(found.missing.at(0),
              AllOf(HasSubstr("has no settings"), HasSubstr("icp-slam_demo_classic.ini")));
}

TEST(BaselineProgram, keeps_its_settings_except_the_changes) {
  const TemporaryFolder folder;
  install_baseline(folder.path(), baseline_kinds()[0], "");
  const std::string settings = baseline_settings(baselines_in(folder.path()).programs.at(0), "/some/where");
  EXPECT_THAT(settings,
              AllOf(HasSubstr("ALFA"), HasSubstr("/some/where"), Not(HasSubstr("LOG // a remark"))));
  EXPECT_THAT(settings, testing::ContainsRegex("SAVE_3D_SCENE *= *0"));
  EXPECT_THAT(changes_text(baseline_kinds()[1]), HasSubstr("RANDOM_SEED = 1"));
}

}  // namespace
}  // namespace psi_slam
