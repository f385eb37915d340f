// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <sstream>

#include "gui_app.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

struct Output {
  int code = -1;
  std::string out;
  std::string err;
};

Output run(const std::vector<std::string>& arguments) {
  std::ostringstream out;
  std::ostringstream err;
  const int code = run_gui(arguments, out, err);
  return {code, out.str(), err.str()};
}

TEST(GuiCommandLine, prints_version_and_help_without_a_window) {
  EXPECT_EQ(run({"--version"}).code, 0);
  EXPECT_THAT(run({"--version"}).out, StartsWith("psi-slam-gui "));
  EXPECT_THAT(run({"--help"}).out, HasSubstr("--config"));
}

TEST(GuiCommandLine, rejects_wrong_arguments_with_the_messages_of_psi_slam) {
  EXPECT_EQ(run({"--set", "front_end.node_distance_m=abc"}).code, 2);
  EXPECT_THAT(run({"--set", "front_end.node_distance_m=abc"}).err,
              HasSubstr("--set: front_end.node_distance_m = abc: expected a number of metres"));
  EXPECT_THAT(run({"--confg", "x.ini"}).err, HasSubstr("did you mean \"--config\"?"));
  EXPECT_THAT(run({"a.log", "b.log"}).err, HasSubstr("unexpected argument \"b.log\""));
  EXPECT_THAT(run({"-c", "/missing.ini"}).err, HasSubstr("/missing.ini"));
}

TEST(GuiCommandLine, takes_one_log_or_live_source) {
  EXPECT_THAT(run({"--help"}).out, HasSubstr("--sensors"));
  EXPECT_EQ(run({"a.log", "--tcp", "5000"}).code, 2);
  EXPECT_THAT(run({"a.log", "--tcp", "5000"}).err, HasSubstr("name a log or a live source, not both"));
  EXPECT_THAT(run({"--tcp", "x"}).err, HasSubstr("--tcp x: expected the number of a port"));
  EXPECT_THAT(run({"a.log", "--idle-s", "1"}).err, HasSubstr("--idle-s needs a live source"));
  EXPECT_THAT(run({"a.log", "--journal", "my.journal"}).err, HasSubstr("--journal needs a live source"));
  EXPECT_THAT(run({"--tcp", "5000", "--journal", "/dev/null"}).err, HasSubstr("the file exists"));
}

}  // namespace
}  // namespace psi_slam
