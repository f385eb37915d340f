// SPDX-License-Identifier: BSD-3-Clause
#include "batch/sweep_plan.h"

#include <gmock/gmock.h>

#include <set>

#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class SweepPlanTest : public testing::Test {
 protected:
  std::string file(const std::string& name, const std::string& text = "x") const {
    write_file(folder_.path() / name, text);
    return (folder_.path() / name).string();
  }

  SweepRequest request(const std::vector<std::string>& logs) const {
    SweepRequest request;
    request.logs = logs;
    return request;
  }

  std::string refusal(const SweepRequest& request) const {
    return sentence_of([&] { plan_sweep(request, "program"); });
  }

  TemporaryFolder folder_;
};

TEST_F(SweepPlanTest, crosses_logs_settings_and_seeds) {
  SweepRequest asked = request({file("a.log", "1"), file("b.clf", "2")});
  asked.choices = {"map.resolution_m=0.05,0.1", "loop_closure.matcher=csm,ga", "log.max_range_m=40"};
  asked.seeds = {4, 6};
  const SweepPlan plan = plan_sweep(asked, "program");
  EXPECT_THAT(plan.columns, ElementsAre("map.resolution_m", "loop_closure.matcher"))
      << "an option with one value does not vary";
  ASSERT_EQ(plan.runs.size(), 2U * 4 * 3);
  EXPECT_EQ(plan.logs[1].name, "b");
  EXPECT_THAT(plan.runs.front().values, ElementsAre("0.05", "csm"));
  EXPECT_THAT(plan.runs[3].values, ElementsAre("0.05", "ga"));
  EXPECT_EQ(plan.runs[2].seed, 6U);
  EXPECT_THAT(plan.runs[2].settings, HasSubstr("\nseed = 6\n"));
  EXPECT_THAT(plan.runs[2].settings, HasSubstr("\nmax_range_m = 40\n"));
  std::set<std::string> folders;
  for (const SweepRun& run : plan.runs) folders.insert(run.folder);
  EXPECT_EQ(folders.size(), plan.runs.size());
}

TEST_F(SweepPlanTest, the_key_depends_on_everything_that_the_result_depends_on) {
  const std::string log = file("a.log", "1");
  const SweepRequest asked = request({log});
  const std::string key = plan_sweep(asked, "program").runs.front().key;
  EXPECT_EQ(plan_sweep(asked, "program").runs.front().key, key);
  EXPECT_NE(plan_sweep(asked, "other program").runs.front().key, key);
  SweepRequest other = asked;
  other.seeds = {2, 2};
  EXPECT_NE(plan_sweep(other, "program").runs.front().key, key);
  other = asked;
  other.choices = {"map.resolution_m=0.2"};
  EXPECT_NE(plan_sweep(other, "program").runs.front().key, key);
  file("a.relations");
  EXPECT_NE(plan_sweep(asked, "program").runs.front().key, key) << "found beside the log";
  EXPECT_EQ(plan_sweep(asked, "program").logs.front().relations, folder_.path() / "a.relations");
  file("a.log", "2");
  EXPECT_NE(plan_sweep(request({file("c.log", "1")}), "program").runs.front().key,
            plan_sweep(asked, "program").runs.front().key);
}

TEST_F(SweepPlanTest, files_and_choices_override_the_logs_own_settings) {
  const std::string log = file("a.log");
  const std::string own = file("own.ini", "[log]\nmax_range_m = 30\n[map]\nresolution_m = 0.2\n");
  SweepRequest asked = request({log + '@' + own});
  asked.configs = {file("c.ini", "[map]\nresolution_m = 0.1\n"),
                   file("d.ini", "[map]\nresolution_m = 0.3\n")};
  SweepPlan plan = plan_sweep(asked, "program");
  EXPECT_THAT(plan.columns, ElementsAre("config"));
  EXPECT_THAT(plan.runs[0].settings, HasSubstr("\nmax_range_m = 30\n"));
  EXPECT_THAT(plan.runs[0].settings, HasSubstr("\nresolution_m = 0.1\n"));
  EXPECT_THAT(plan.runs[1].settings, HasSubstr("\nresolution_m = 0.3\n"));
  asked.configs.clear();
  asked.choices = {"log.max_range_m=20"};
  plan = plan_sweep(asked, "program");
  EXPECT_THAT(plan.runs[0].settings, HasSubstr("\nmax_range_m = 20\n"));
  EXPECT_THAT(plan.runs[0].settings, HasSubstr("\nresolution_m = 0.2\n"));
}

TEST_F(SweepPlanTest, finds_a_logs_own_settings_by_its_name) {
  SweepRequest asked = request({file("a.log")});
  EXPECT_EQ(plan_sweep(asked, "program").logs.front().ini, "");
  file("a.ini", "[log]\nmax_range_m = 30\n");
  EXPECT_EQ(plan_sweep(asked, "program").logs.front().ini, folder_.path() / "a.ini") << "beside the log";
  std::filesystem::create_directory(folder_.path() / "ini");
  asked.ini_folder = (folder_.path() / "ini").string();
  EXPECT_EQ(plan_sweep(asked, "program").logs.front().ini, "");
  file("ini/a.ini", "[log]\nmax_range_m = 20\n");
  EXPECT_THAT(plan_sweep(asked, "program").runs.front().settings, HasSubstr("\nmax_range_m = 20\n"));
}

TEST_F(SweepPlanTest, accepts_an_at_sign_in_a_log_name_and_two_logs_of_one_name) {
  std::filesystem::create_directory(folder_.path() / "sub");
  const std::string log = file("robot@lab.log");
  const std::string namesake = file("sub/robot@lab.log", "other");
  const SweepPlan plan = plan_sweep(request({log, namesake}), "program");
  EXPECT_EQ(plan.logs[0].name, log);
  EXPECT_EQ(plan.logs[1].name, namesake);
}

TEST_F(SweepPlanTest, a_log_may_be_a_folder) {
  std::filesystem::create_directory(folder_.path() / "recording");
  file("recording/0.db3", "1");
  const SweepRequest asked = request({(folder_.path() / "recording").string() + '/'});
  const SweepPlan plan = plan_sweep(asked, "program");
  EXPECT_EQ(plan.logs.front().name, "recording");
  EXPECT_EQ(plan.logs.front().bytes, 1U);
  file("recording/1.db3", "2");
  EXPECT_NE(plan_sweep(asked, "program").runs.front().key, plan.runs.front().key);
  file("recording.ini", "[log]\nmax_range_m = 30\n");
  EXPECT_EQ(plan_sweep(asked, "program").logs.front().ini, folder_.path() / "recording.ini");
}

TEST_F(SweepPlanTest, refuses_wrong_requests_in_one_sentence) {
  const std::string log = file("a.log");
  EXPECT_THAT(refusal(request({})), HasSubstr("name the logs"));
  EXPECT_THAT(refusal(request({log + "x"})), HasSubstr("a.logx is not a file"));
  EXPECT_THAT(refusal(request({log + "@none.ini"})), HasSubstr("none.ini is not a file"));
  EXPECT_THAT(refusal(request({log, log})), HasSubstr("would be equal"));
  const auto with_choice = [&](const std::vector<std::string>& choices) {
    SweepRequest asked = request({log});
    asked.choices = choices;
    return refusal(asked);
  };
  EXPECT_THAT(with_choice({"map.resolution_m=0.1,0.1"}), HasSubstr("would be equal"));
  EXPECT_THAT(with_choice({"map.resolution_m=0.1,wide"}), HasSubstr("map.resolution_m"));
  EXPECT_THAT(with_choice({"map.resolution_m"}), HasSubstr("expected SECTION.KEY=VALUE"));
  EXPECT_THAT(with_choice({"map.resolution_m=1", "map.resolution_m=2"}), HasSubstr("is set twice"));
  EXPECT_THAT(with_choice({"front_end.window_m=0.1,0.2"}), HasSubstr("is not an option, so all runs would be equal"));
  EXPECT_THAT(with_choice({"run.seed=1,2"}), HasSubstr("with --seeds"));
  EXPECT_THAT(with_choice({"log.laser=FLASER,RLASER"}), HasSubstr("log.laser is a list"));
  SweepRequest asked = request({log, file("b.log", "y")});
  asked.relations = log;
  EXPECT_THAT(refusal(asked), HasSubstr("--relations works with one log"));
}

}  // namespace
}  // namespace psi_slam
