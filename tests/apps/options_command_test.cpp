// SPDX-License-Identifier: BSD-3-Clause
// Tests "psi-slam options", which explains all options of the settings files or some of them.
#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app_run.h"
#include "command_line.h"

namespace psi_slam {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

json listed(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"options", "--json"});
  const AppRun run = run_app(arguments);
  EXPECT_EQ(run.code, 0) << run.err;
  return json::parse(run.out);
}

TEST(OptionsCommand, json_has_every_option_with_its_values) {
  const json all = listed({});
  std::size_t described = 0;
  const auto settings = default_settings();
  for (const OptionSection& section : settings->sections()) described += section.options.size();
  EXPECT_EQ(all.size(), described);
  const auto option = [&](const std::string& name) {
    return *std::find_if(all.begin(), all.end(), [&](const json& one) { return one["name"] == name; });
  };
  const json resolution = option("map.resolution_m");
  EXPECT_EQ(resolution["type"], "number");
  EXPECT_EQ(resolution["default"], "0.05");
  EXPECT_EQ(resolution["unit"], "m");
  EXPECT_TRUE(resolution.contains("min") || resolution.contains("above"));
  EXPECT_THAT(option("loop_closure.matcher")["choices"].dump(), HasSubstr("csm_ga"));
  EXPECT_EQ(option("log.max_range_m")["may_be_auto"], true);
}

TEST(OptionsCommand, a_word_selects_options_by_name_and_description) {
  const AppRun run = run_app({"options", "RESOLUTION"});
  EXPECT_EQ(run.code, 0);
  EXPECT_THAT(run.out, AllOf(HasSubstr("  map.resolution_m\n"), HasSubstr("[map]")));
  EXPECT_THAT(run.out, Not(HasSubstr("run.threads")));
  EXPECT_LT(listed({"resolution"}).size(), listed({}).size());
  const AppRun none = run_app({"options", "zebra"});
  EXPECT_EQ(none.code, 2);
  EXPECT_EQ(none.err,
            "psi-slam: no option has \"zebra\" in its name or description. psi-slam options lists all\n");
}

TEST(OptionsCommand, the_common_options_are_ten) {
  EXPECT_EQ(listed({"--common"}).size(), 10U);
  EXPECT_THAT(run_app({"options", "--common", "--markdown"}).err, HasSubstr("--markdown prints all options"));
}

}  // namespace
}  // namespace psi_slam
