// SPDX-License-Identifier: BSD-3-Clause
#include <nlohmann/json.hpp>

#include "baseline_files.h"
#include "command_fixture.h"
#include "well_formed.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using Json = nlohmann::json;

class FreiburgCommand : public BenchCommand {
 protected:
  FreiburgCommand() : BenchCommand("freiburg") {}

  /// Runs the built program as a child process, because the command starts its own program for each run.
  ChildEnd run(std::vector<std::string> options) const {
    return run_process(words("freiburg", with_output(std::move(options))), path_);
  }

  std::string refusal(std::vector<std::string> options) {
    return BenchCommand::refusal(with_output(std::move(options)));
  }

  std::vector<std::string> with_output(std::vector<std::string> options) const {
    options.insert(options.begin(), {"-o", output_.string()});
    return options;
  }

  fs::path output_ = folder_.path() / "out" / "freiburg";
  std::string path_ = (folder_.path() / "bin").string() + ":/usr/bin:/bin";
};

TEST_F(FreiburgCommand, maps_the_logs_and_writes_page_figures_and_plots) {
  write_room();
  write_room_passes(data_);
  write_lines(data_ / "unknown.log", room_log_lines(2));
  write_file(ini_ / "unknown.ini", "[log]\n");
  const fs::path json_file = folder_.path() / "freiburg.json";
  const ChildEnd end = run({"--seeds", "2", "--matchers", "csm,adaptive", "--json", json_file.string()});
  ASSERT_EQ(end.code, 0) << end.err;
  EXPECT_EQ(end.out, read_file(output_ / "freiburg.md"));
  EXPECT_THAT(end.out, AllOf(HasSubstr("| room | csm | 1 run: draws no random numbers | 0.0"),
                             HasSubstr("| room | csm | 1 run: draws no random numbers | 0 by construction |"),
                             HasSubstr("| room | adaptive | 2 | 0.0"), HasSubstr("seeds 1 to 2"),
                             HasSubstr("Freiburg hospital: its log is not in the folder"),
                             HasSubstr("unknown has no relations"), HasSubstr("Hess")));
  EXPECT_EQ(complaint_about(read_file(output_ / "freiburg-room.svg")), "");
  EXPECT_TRUE(fs::exists(output_ / "runs" / "room-adaptive-2.json"));
  const Json json = Json::parse(read_file(json_file));
  EXPECT_EQ(json["cells"].size(), 2U);
  EXPECT_EQ(json["cells"][1]["runs"], 2);
  EXPECT_LT(json["cells"][1]["translation_abs_m"]["mean"], 0.1);
  EXPECT_GE(json["cells"][1]["translation_abs_m"]["over_seeds"]["max"],
            json["cells"][1]["translation_abs_m"]["over_seeds"]["min"]);
  EXPECT_EQ(json["cells"][0]["loops_false"]["mean"], 0);
  EXPECT_GT(json["cells"][0]["loops_judged"]["min"], 10);
  EXPECT_GT(json["cells"][0]["loop_recall"]["mean"], 0.8);
  EXPECT_THAT(end.out,
              AllOf(HasSubstr("| false of judged | recall % |"),
                    HasSubstr("| 0.0 of " +
                              std::to_string(json["cells"][0]["loops_judged"]["min"].get<int>()) + ".0 | ")));
  EXPECT_EQ(json["logs"][0]["sha256"].get<std::string>().size(), 64U);
  EXPECT_THAT(end.out, HasSubstr(json["logs"][0]["sha256"].get<std::string>()));
  EXPECT_NE(json["commit"], "");
}

TEST_F(FreiburgCommand, a_failed_run_gives_exit_code_1) {
  write_room();
  write_file(data_ / "room.relations", "1 2 0 0 0 0 0 0\n");  // times long before the log
  const ChildEnd end = run({"--matchers", "csm"});
  EXPECT_EQ(end.code, 1);
  EXPECT_THAT(end.err, HasSubstr("1 run failed"));
  EXPECT_THAT(end.out, HasSubstr("| room | csm | failed: "));
}

TEST_F(FreiburgCommand, compares_with_installed_baselines) {
  write_room();
  install_baseline(folder_.path(), baseline_kinds()[0], standing_still(190));
  install_baseline(folder_.path(), baseline_kinds()[1], "exec sleep 600");
  const fs::path json_file = folder_.path() / "freiburg.json";
  const ChildEnd end =
      run({"--matchers", "csm", "--baselines", "--baseline-limit-s", "1", "--json", json_file.string()});
  ASSERT_EQ(end.code, 0) << end.err;
  EXPECT_THAT(end.out, AllOf(HasSubstr("MRPT icp-slam (run here)"), HasSubstr("MRPT 9.9.9 - Sources"),
                             HasSubstr("| room | icp-slam | "),
                             HasSubstr("| room | rbpf-slam | not finished in 1 s | –")));
  const Json json = Json::parse(read_file(json_file));
  ASSERT_EQ(json["rivals"]["runs"].size(), 2U);
  EXPECT_EQ(json["rivals"]["runs"][0]["figures"]["scans"], 190);
  EXPECT_EQ(json["rivals"]["runs"][1]["not_finished_in_s"], 1);
  EXPECT_THAT(read_file(output_ / "freiburg-room.svg"), HasSubstr("MRPT icp-slam (run here)"));
}

TEST_F(FreiburgCommand, names_missing_baselines) {
  write_room();
  path_ = (folder_.path() / "bin").string();
  const ChildEnd none = run({"--matchers", "csm", "--baselines"});
  EXPECT_EQ(none.code, 2);
  EXPECT_THAT(none.err,
              AllOf(HasSubstr("icp-slam is not on PATH, rbpf-slam is not on PATH"), HasSubstr("mrpt-apps")));
  install_baseline(folder_.path(), baseline_kinds()[1], "exit 3");
  write_file(folder_.path() / "bin" / "icp-slam", "no program");
  const ChildEnd one = run({"--matchers", "csm", "--baselines"});
  EXPECT_EQ(one.code, 0) << one.err;
  EXPECT_THAT(one.err, HasSubstr("warning: --baselines: icp-slam is not on PATH"));
  EXPECT_THAT(one.out, HasSubstr("- not run: icp-slam is not on PATH"));
  EXPECT_THAT(one.out, HasSubstr("| room | rbpf-slam | failed: ended with code 3 | –"));
}

TEST_F(FreiburgCommand, wrong_usage_and_input_give_one_sentence_and_exit_code_2) {
  EXPECT_THAT(refusal({}), HasSubstr("there is no log in " + data_.string()));
  write_room();
  EXPECT_THAT(refusal({"--bogus"}), HasSubstr("--bogus"));
  EXPECT_THAT(refusal({"--seeds", "0"}), HasSubstr("--seeds"));
  EXPECT_THAT(refusal({"--seeds", "-1"}), HasSubstr("--seeds"));
  EXPECT_THAT(refusal({"--baseline-limit-s", "5"}), HasSubstr("--baselines"));
  EXPECT_THAT(refusal({"--baselines", "--baseline-limit-s", "0"}), HasSubstr("--baseline-limit-s"));
  EXPECT_THAT(refusal({"--processes", "0"}), HasSubstr("--processes"));
  EXPECT_THAT(refusal({"--threads", "some"}), HasSubstr("--threads"));
  EXPECT_THAT(refusal({"--matchers", "csm,icp"}), AllOf(HasSubstr("--matchers"), HasSubstr("icp")));
  EXPECT_THAT(refusal({"--matchers", "csm,ga,csm"}), HasSubstr("csm is named twice"));
  EXPECT_THAT(refusal({"--logs", "intel"}),
              AllOf(HasSubstr("no log called intel"), HasSubstr(data_.string())));
  EXPECT_THAT(refusal({"--json", folder_.path().string()}), HasSubstr("is a folder"));
  write_file(ini_ / "room.ini", "[log]\nbogus = 1\n");
  EXPECT_THAT(refusal({}), HasSubstr("bogus"));
  fs::remove(data_ / "room.relations");
  EXPECT_THAT(refusal({}), HasSubstr("expected NAME.relations"));
  EXPECT_THAT(refusal({"--logs", "room"}), HasSubstr("expected room.relations"));
}

TEST_F(FreiburgCommand, refuses_an_impossible_output_folder_before_the_work) {
  write_room();
  output_ = data_ / "room.log";
  EXPECT_THAT(refusal({}), HasSubstr("room.log"));
}

}  // namespace
}  // namespace psi_slam
