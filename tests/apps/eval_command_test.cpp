// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "app_run.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;

class EvalCommand : public ::testing::Test {
 protected:
  EvalCommand() {
    std::ofstream(trajectory_) << "1 0 0 0\n2 3 0 0\n3 6 4 0\n";
    std::ofstream(relations_) << "1 2 3 0 0 0 0 0\n1 3 3 0 0 0 0 0\n1 2.5 4.5 2 0 0 0 0\n1 99 0 0 0 0 0 0\n";
  }

  int run(std::vector<std::string> options = {}) {
    options.insert(options.begin(), {trajectory_, relations_});
    return run_only(options);
  }

  int run_only(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "eval");
    const AppRun run = run_app(arguments);
    out_ = run.out;
    err_ = run.err;
    return run.code;
  }

  static std::string contents(const std::string& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  TemporaryFolder folder_;
  std::string trajectory_ = (folder_.path() / "trajectory.txt").string();
  std::string relations_ = (folder_.path() / "true.relations").string();
  std::string csv_ = (folder_.path() / "errors.csv").string();
  std::string out_;
  std::string err_;
};

TEST_F(EvalCommand, prints_both_metrics_by_name_and_what_was_used) {
  EXPECT_EQ(run(), 0);
  EXPECT_THAT(out_,
              AllOf(HasSubstr("3 used (1 of them interpolated), 1 skipped"), HasSubstr("mmerle et al. 2009"),
                    HasSubstr("Cartographer"), HasSubstr("1.6667 ± 2.3570"), HasSubstr("5.0000")));
  EXPECT_EQ(err_, "");
}

TEST_F(EvalCommand, json_holds_the_same_figures) {
  EXPECT_EQ(run({"--json"}), 0);
  const auto json = nlohmann::json::parse(out_);
  EXPECT_EQ(json["relations"]["used"], 3);
  EXPECT_EQ(json["relations"]["exact"], 2);
  EXPECT_EQ(json["relations"]["interpolated"], 1);
  EXPECT_EQ(json["relations"]["skipped"], 1);
  EXPECT_NEAR(json["translation_abs_m"]["mean"], 5.0 / 3, 1e-9);
  EXPECT_NEAR(json["cartographer_translation_abs_m"]["max"], 5, 1e-9);
}

TEST_F(EvalCommand, a_narrower_gap_skips_more) {
  EXPECT_EQ(run({"--json", "--max-gap", "0.5"}), 0);
  EXPECT_EQ(nlohmann::json::parse(out_)["relations"]["skipped"], 2);
}

TEST_F(EvalCommand, writes_one_row_a_relation_and_never_replaces_a_file_unasked) {
  EXPECT_EQ(run({"--per-relation", csv_}), 0);
  EXPECT_EQ(contents(csv_),
            "time1,time2,translation_m,rotation_deg,cartographer_translation_m,interpolated\n"
            "1.000000,2.000000,0.000000000,0.000000000,0.000000000,0\n"
            "1.000000,3.000000,5.000000000,0.000000000,5.000000000,0\n"
            "1.000000,2.500000,0.000000000,0.000000000,0.000000000,1\n");
  std::ofstream(csv_) << "precious";
  EXPECT_EQ(run({"--per-relation", csv_}), 2);
  EXPECT_EQ(contents(csv_), "precious");
  EXPECT_EQ(err_, "psi-slam: " + csv_ + ": the file exists. Name another file, or replace it with --force\n");
  EXPECT_EQ(run({"--per-relation", csv_, "--force"}), 0);
  EXPECT_THAT(contents(csv_), HasSubstr("time1,time2"));
}

TEST_F(EvalCommand, wrong_usage_and_wrong_input_exit_with_2) {
  EXPECT_EQ(run_only({}), 2);
  EXPECT_EQ(run({"--max-gap", "-1"}), 2);
  EXPECT_EQ(run({"--max-gap", "long"}), 2);
  EXPECT_EQ(run({"--max-gap", "nan"}), 2);
  EXPECT_EQ(run({"--colour"}), 2);
  EXPECT_EQ(out_, "");
  EXPECT_EQ(run_only({folder_.path() / "missing.tum", relations_}), 2);
  EXPECT_THAT(err_, HasSubstr("missing.tum: No such file"));
  std::ofstream(relations_) << "1 2 3\n";
  EXPECT_EQ(run(), 2);
  EXPECT_THAT(err_, HasSubstr("true.relations:1: expected"));
}

TEST_F(EvalCommand, relations_that_match_nothing_are_told_in_one_sentence) {
  std::ofstream(relations_) << "101 102 3 0 0 0 0 0\n103 104 3 0 0 0 0 0\n";
  EXPECT_EQ(run({"--per-relation", csv_}), 2);
  EXPECT_EQ(out_, "");
  EXPECT_THAT(err_, MatchesRegex("psi-slam: [^\n]+\n"));
  EXPECT_THAT(err_, AllOf(HasSubstr("101"), HasSubstr("104"))) << "the time span of the relations";
  EXPECT_FALSE(std::filesystem::exists(csv_));
}

TEST_F(EvalCommand, a_result_that_cannot_be_written_exits_with_1) {
  EXPECT_EQ(run({"--per-relation", (folder_.path() / "missing" / "errors.csv").string()}), 1);
  EXPECT_THAT(err_, HasSubstr("cannot write"));
}

TEST_F(EvalCommand, tells_its_options) {
  EXPECT_EQ(run_only({"--help"}), 0);
  EXPECT_THAT(out_, AllOf(HasSubstr("--max-gap"), HasSubstr("--per-relation"), HasSubstr("--json")));
}

}  // namespace
}  // namespace psi_slam
