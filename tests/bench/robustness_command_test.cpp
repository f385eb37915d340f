// SPDX-License-Identifier: BSD-3-Clause
#include <nlohmann/json.hpp>

#include "command_fixture.h"
#include "robustness/robustness_benchmark.h"
#include "well_formed.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using Json = nlohmann::json;

class RobustnessCommand : public BenchCommand {
 protected:
  RobustnessCommand() : BenchCommand("robustness") {}

  void write_passed_room() const {
    write_room();
    write_room_passes(data_);
  }

  fs::path output_ = folder_.path() / "out" / "robustness";
};

TEST_F(RobustnessCommand, maps_the_log_in_every_case_and_writes_page_figures_and_plots) {
  write_passed_room();
  const fs::path json_file = folder_.path() / "robustness.json";
  ASSERT_EQ(run({"--json", json_file.string(), "-o", output_.string()}, true), 0) << err_.str();
  EXPECT_THAT(err_.str(), HasSubstr("room, as it is"));
  EXPECT_EQ(out_.str(), read_file(output_ / "robustness.md"));
  for (const char* series : {"odometry-noise", "scans-kept", "field-of-view"}) {
    const std::string svg = read_file(output_ / ("robustness-" + std::string(series) + ".svg"));
    EXPECT_THAT(svg, AllOf(HasSubstr("</svg>"), HasSubstr(">room<")));
    EXPECT_EQ(complaint_about(svg), "") << series;
  }

  const Json json = Json::parse(read_file(json_file));
  EXPECT_EQ(json["schema"], "psi-slam-robustness");
  EXPECT_GT(json["logs"][0]["natural_odometry_noise"]["deg_per_root_rad"], 0)
      << "its rotations are too large";
  EXPECT_EQ(json["files"][0]["sha256"].get<std::string>().size(), 64U);
  EXPECT_THAT(out_.str(), HasSubstr(json["files"][0]["sha256"].get<std::string>()));
  const std::vector<RobustnessCase> cases = robustness_cases(1);
  ASSERT_EQ(json["rows"].size(), cases.size());
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const Json& row = json["rows"][i];
    EXPECT_EQ(row["series"], cases[i].series);
    EXPECT_EQ(row["case"], cases[i].name);
    EXPECT_THAT(out_.str(), HasSubstr("| room | " + cases[i].series + " | " + cases[i].name + " | "));
    EXPECT_GT(row["translation_error_m"]["mean"], 0);
    EXPECT_GT(row["relations"]["min"], 0);
  }
}

TEST_F(RobustnessCommand, writes_files_only_on_request) {
  write_passed_room();
  ASSERT_EQ(run({"--logs", "room"}), 0);
  EXPECT_EQ(err_.str(), "") << "no terminal, no progress";
  EXPECT_THAT(out_.str(), HasSubstr("# Degraded logs"));
  EXPECT_FALSE(fs::exists(output_));
}

TEST_F(RobustnessCommand, repeats_its_figures_for_a_seed_and_changes_them_for_another) {
  write_passed_room();
  std::vector<Json> runs;
  for (const char* seed : {"5-5", "5-5", "6-6"}) {
    const fs::path file = folder_.path() / "figures.json";
    ASSERT_EQ(run({"--seeds", seed, "--json", file.string()}), 0) << err_.str();
    runs.push_back(Json::parse(read_file(file)));
  }
  EXPECT_EQ(runs[0], runs[1]);
  EXPECT_EQ(runs[0]["seeds"], Json({5}));
  for (std::size_t i = 0; i < runs[0]["rows"].size(); ++i) {
    Json& row = runs[0]["rows"][i];
    row.erase("seeds");
    runs[2]["rows"][i].erase("seeds");
    const bool noisy = row["case"] == "× 2" || row["case"] == "× 4";
    EXPECT_EQ(row != runs[2]["rows"][i], noisy) << row;
  }
}

TEST_F(RobustnessCommand, wrong_usage_and_input_give_one_sentence_and_exit_code_2) {
  EXPECT_THAT(refusal({}), HasSubstr("there is no log in " + data_.string()));
  write_passed_room();
  EXPECT_THAT(refusal({"--bogus"}), HasSubstr("--bogus"));
  EXPECT_THAT(refusal({"--seeds", "some"}), HasSubstr("--seeds"));
  EXPECT_THAT(refusal({"--seeds", "2-1"}), HasSubstr("--seeds"));
  EXPECT_THAT(refusal({"--logs", "room,hall"}), HasSubstr("no log called hall"));
  EXPECT_THAT(refusal({"--json", folder_.path().string()}), HasSubstr("is a folder"));
  EXPECT_THAT(refusal({"--json", (folder_.path() / "no" / "a.json").string()}), HasSubstr("does not exist"));
  EXPECT_THAT(refusal({"-o", (data_ / "room.log").string()}), HasSubstr("room.log"));
  write_file(ini_ / "room.ini", "[log]\nbogus = 1\n");
  EXPECT_THAT(refusal({}), HasSubstr("bogus"));
  fs::remove(data_ / "room.relations");
  EXPECT_THAT(refusal({}), HasSubstr("NAME.relations"));
  EXPECT_THAT(refusal({"--logs", "room"}), HasSubstr("expected room.relations"));
}

}  // namespace
}  // namespace psi_slam
