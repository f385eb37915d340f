// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include "app_run.h"

namespace psi_slam {
namespace {

TEST(Documentation, options_page_equals_the_programs_output) {
  const std::string page = bytes_of(PSI_SLAM_DOC_FOLDER "/options.md");
  const AppRun run = run_app({"options", "--markdown"});
  ASSERT_EQ(run.code, 0);
  ASSERT_NE(run.out, "");
  const std::size_t begin = page.find("## ");
  ASSERT_NE(begin, std::string::npos);
  EXPECT_EQ(page.substr(begin), run.out)
      << "replace the sections of options.md by: psi-slam options --markdown";
}

}  // namespace
}  // namespace psi_slam
