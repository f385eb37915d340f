// SPDX-License-Identifier: BSD-3-Clause
#include "commands.h"

#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "../session/room_log.h"
#include "app_run.h"
#include "temporary_folder.h"
#include "two_lasers.h"

namespace psi_slam {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;
using Json = nlohmann::json;

class LogCheck : public testing::Test {
 protected:
  TemporaryFolder folder_;
  std::string log_ = write_lines(folder_.path() / "room.log", room_log_lines(60)).string();
};

TEST_F(LogCheck, prints_what_the_log_holds) {
  const AppRun run = run_app({"check", log_});
  EXPECT_EQ(run.code, 0);
  EXPECT_EQ(run.err, "");
  EXPECT_THAT(run.out, HasSubstr("room.log: CARMEN, 60 scans by FLASER of 181 beams"));
  EXPECT_THAT(run.out, HasSubstr("odometry: "));
}

TEST_F(LogCheck, prints_json) {
  const AppRun run = run_app({"check", "--json", log_});
  EXPECT_EQ(run.code, 0);
  EXPECT_EQ(Json::parse(run.out)["facts"]["scans"], 60);
}

TEST_F(LogCheck, uses_the_settings) {
  const AppRun run =
      run_app({"check", "--json", log_, "--set", "log.max_range_m=2.5", "--set", "log.laser_x_m=0.3"});
  const Json facts = Json::parse(run.out)["facts"];
  EXPECT_EQ(facts["ranges"]["max_range_m"], 2.5);
  EXPECT_EQ(facts["robot_T_laser"]["x_m"], 0.3);
}

TEST_F(LogCheck, a_damaged_log_is_checked_up_to_the_damage) {
  std::ofstream(log_, std::ios::app) << "FLASER 181 1.0";
  const AppRun run = run_app({"check", log_});
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.out, AllOf(HasSubstr("60 scans by FLASER"), HasSubstr("the file is cut off in this line")));
  EXPECT_THAT(run.err, AllOf(StartsWith("psi-slam: "), HasSubstr("room.log:61: FLASER: ")));
}

TEST_F(LogCheck, a_log_without_returns_gets_the_answer_of_mapping) {
  const auto flaser = [](const std::string& range, int scan) {
    std::string line = "FLASER 180";
    for (int beam = 0; beam < 180; ++beam) line += ' ' + range;
    const std::string pose = ' ' + std::to_string(0.1 * scan) + " 0 0";
    const std::string stamp = ' ' + std::to_string(100 + 0.2 * scan);
    return line + pose + pose + stamp + " host" + stamp;
  };
  const auto expect_same_answer = [&](const std::string& log, const std::vector<std::string>& options) {
    std::vector<std::string> check{"check", log};
    check.insert(check.end(), options.begin(), options.end());
    std::vector<std::string> map{log, "-q", "-o", (folder_.path() / "out").string()};
    map.insert(map.end(), options.begin(), options.end());
    const AppRun checked = run_app(check);
    EXPECT_EQ(checked.code, 2);
    EXPECT_THAT(checked.out, HasSubstr("verdict: cannot be mapped"));
    EXPECT_THAT(checked.err, HasSubstr("scans has a return between log.min_range_m and log.max_range_m"));
    const AppRun mapped = run_app(map);
    EXPECT_EQ(mapped.code, 2);
    EXPECT_EQ(mapped.err, checked.err);
  };
  for (const char* range : {"0", "nan", "inf", "-1", "81.83", "2000"}) {
    SCOPED_TRACE(range);
    std::vector<std::string> lines;
    for (int scan = 0; scan < 20; ++scan) lines.push_back(flaser(range, scan));
    expect_same_answer(write_lines(folder_.path() / "empty.log", lines).string(), {});
  }
  expect_same_answer(log_, {"--set", "log.min_range_m=90", "--set", "log.max_range_m=100"});
  write_rawlog_of(folder_.path() / "two.rawlog", TwoLasers());
  expect_same_answer((folder_.path() / "two.rawlog").string(),
                     {"--set", "log.min_range_m=90", "--set", "log.max_range_m=100"});
}

TEST_F(LogCheck, an_unreadable_log_is_wrong_input) {
  const AppRun run = run_app({"check", "missing.log"});
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err, HasSubstr("missing.log does not exist"));
}

}  // namespace
}  // namespace psi_slam
