// SPDX-License-Identifier: BSD-3-Clause
#include "other_programs.h"

#include <gmock/gmock.h>

#include "app_run.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST(OtherPrograms, commands_run_the_programs_of_the_family) {
  const TemporaryFolder folder;
  for (const OtherProgram& other : other_programs()) {
    if (std::string(other.command) == "gui") continue;  // needs the libraries of a desktop
    const AppRun run = AppProcess({other.command, "--version"}, folder.path()).finish();
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr(std::string(other.program) + ' '));
    const AppRun help = AppProcess({"help", other.command}, folder.path()).finish();
    EXPECT_THAT(help.out, HasSubstr(std::string(other.program)));
    const AppRun option_first = AppProcess({"-h", other.command}, folder.path()).finish();
    EXPECT_EQ(option_first.out, help.out);
  }
  const AppRun freiburg = AppProcess({"help", "bench", "freiburg"}, folder.path()).finish();
  EXPECT_EQ(freiburg.code, 0) << freiburg.err;
  EXPECT_THAT(freiburg.out, HasSubstr("psi-slam-bench freiburg"));
  EXPECT_THAT(freiburg.out, HasSubstr("--processes N "));
  const AppRun wrong = AppProcess({"bench", "nothing"}, folder.path()).finish();
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("psi-slam-bench: "));
}

TEST(OtherPrograms, a_program_that_is_not_installed_is_named_with_its_package) {
  const TemporaryFolder folder;
  const fs::path alone = folder.path() / "psi-slam";
  fs::copy_file(PSI_SLAM_PROGRAM, alone);
  const auto fails = [&](const std::vector<std::string>& arguments, const std::string& sentence) {
    const AppRun run = AppProcess(
                           arguments, folder.path(), [] { ::setenv("PATH", "/nowhere", 1); }, alone.string())
                           .finish();
    EXPECT_EQ(run.code, 2);
    EXPECT_EQ(run.err, sentence);
  };
  fails({"gui"},
        "psi-slam: psi-slam gui runs psi-slam-gui, which is neither beside psi-slam nor in PATH. Debian's "
        "package psi-slam contains it\n");
  fails(
      {"bench", "match"},
      "psi-slam: psi-slam bench runs psi-slam-bench, which is neither beside psi-slam nor in PATH. Debian's "
      "package psi-slam-bench contains it\n");
}

}  // namespace
}  // namespace psi_slam
