// SPDX-License-Identifier: BSD-3-Clause
#include <nlohmann/json.hpp>

#include "command_fixture.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Json = nlohmann::json;

class PaperCommand : public BenchCommand {
 protected:
  PaperCommand() : BenchCommand("paper") { write_room(); }

  fs::path output_ = folder_.path() / "out" / "paper";
  fs::path json_ = folder_.path() / "paper.json";
};

TEST_F(PaperCommand, maps_the_logs_with_each_matcher_and_counts_loops_and_searches) {
  ASSERT_EQ(run({"--matchers", "ga,csm", "--json", json_.string(), "-o", output_.string()}, true), 0)
      << err_.str();
  EXPECT_THAT(err_.str(), HasSubstr("room, csm"));
  EXPECT_EQ(out_.str(), read_file(output_ / "paper.md"));
  const Json rows = Json::parse(read_file(json_))["rows"];
  ASSERT_EQ(rows.size(), 2U);
  std::vector<std::string> names;
  for (const Json& row : rows) {
    names.push_back(row["matcher"]);
    EXPECT_GT(row["searches"], 20) << "one for each half metre of 40 m";
    EXPECT_LT(row["searches"], 100);
    EXPECT_GT(row["windows"], 0);
    EXPECT_GT(row["loops"], 0);
    EXPECT_LT(row["translation_abs_m"]["mean"], 0.1) << "the room is easy";
    EXPECT_DOUBLE_EQ(row["deadline_ms"], 200.0);
    EXPECT_GE(row["back_end_ms"]["max"], row["back_end_ms"]["p50"]);
  }
  EXPECT_THAT(names, testing::ElementsAre("csm", "ga"));
  EXPECT_EQ(rows[0]["search_kinds"]["branch_and_bound"], rows[0]["windows"]) << "all windows are large";
  EXPECT_EQ(rows[1]["search_kinds"]["genetic"], rows[1]["windows"]);
}

TEST_F(PaperCommand, wrong_usage_and_input_give_one_sentence_and_exit_code_2) {
  EXPECT_THAT(refusal({"--matchers", "icp"}), HasSubstr("--matchers"));
  EXPECT_THAT(refusal({"--logs", "garden"}), HasSubstr("no log called garden"));
  EXPECT_THAT(refusal_of({"paper"}), HasSubstr("--data"));
}

}  // namespace
}  // namespace psi_slam
