// SPDX-License-Identifier: BSD-3-Clause
#include "bench_app.h"

#include <nlohmann/json.hpp>

#include "command_fixture.h"
#include "map/trajectory/relations_metric.h"
#include "progress_line.h"
#include "psi_slam/open_log.h"
#include "psi_slam/time_stamp.h"
#include "shared_logs.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::MatchesRegex;
using testing::Not;
using Json = nlohmann::json;

class BenchApp : public BenchCommand {
 protected:
  BenchApp() : BenchCommand("match") {}
};

TEST_F(BenchApp, compares_the_matchers_on_a_log) {
  write_room();
  const fs::path json_file = folder_.path() / "match.json";
  const fs::path output = folder_.path() / "out" / "bench";
  ASSERT_EQ(run({"--cases", "1", "--json", json_file.string(), "-o", output.string()}, true), 0)
      << err_.str();
  EXPECT_THAT(err_.str(), AllOf(HasSubstr("mapping room"), HasSubstr(" left")));
  EXPECT_EQ(out_.str(), read_file(output / "match.md"));
  EXPECT_THAT(out_.str(), HasSubstr("Single scans: the log has only 0 of 1 negative cases"))
      << "the room is too small";
  const Json json = Json::parse(read_file(json_file));
  EXPECT_EQ(json["matchers"][0]["matcher"], "csm");
  EXPECT_EQ(json["matchers"][0]["cases"], 1);
  EXPECT_TRUE(json["matchers"][0]["false_accept_rate"].is_null());
  EXPECT_LT(json["logs"][0]["translation_error_m"], 0.1);
  EXPECT_EQ(json["logs"][0]["positive"], 1);
}

TEST_F(BenchApp, runs_only_the_chosen_parts) {
  write_room();
  const fs::path json_file = folder_.path() / "match.json";
  ASSERT_EQ(run({"--cases", "1", "--parts", "windows", "--json", json_file.string()}), 0) << err_.str();
  EXPECT_THAT(out_.str(), AllOf(HasSubstr("| ±64 m, ±180° | ga | 1 |"), Not(HasSubstr("## Single scans"))));
  const Json json = Json::parse(read_file(json_file));
  EXPECT_TRUE(json["matchers"].empty());
  EXPECT_EQ(json["windows"].size(), 24U);
}

TEST_F(BenchApp, leaves_out_logs_without_a_trustworthy_truth) {
  write_room_benchmark(data_, ini_, 1.5);
  EXPECT_THAT(refusal({}),
              AllOf(HasSubstr("no log can be used: room"), HasSubstr("is too large for a truth")));
  fs::remove(data_ / "room.relations");
  EXPECT_THAT(refusal({}), HasSubstr("it has no relations"));
}

TEST_F(BenchApp, repeats_all_figures_but_the_times) {
  write_room();
  std::vector<Json> runs;
  for (const char* name : {"first.json", "again.json"}) {
    const fs::path file = folder_.path() / name;
    ASSERT_EQ(run({"--cases", "3", "--seed", "5", "--json", file.string()}), 0) << err_.str();
    Json json = Json::parse(read_file(file));
    for (Json* rows : {&json["matchers"], &json["context"]["matchers"]})
      for (Json& row : *rows)
        for (const char* times : {"time_ms", "loop_time_ms", "no_loop_time_ms"}) row.erase(times);
    runs.push_back(std::move(json));
  }
  EXPECT_EQ(runs[0], runs[1]);
  EXPECT_EQ(runs[0]["seed"], 5);
}

TEST_F(BenchApp, draws_both_kinds_from_a_benchmark_log_with_the_shipped_settings) {
  if (!shared_file("mit-csail.clf.gz")) GTEST_SKIP() << kNeedsData;
  for (const char* name : {"mit-csail.clf.gz", "mit-csail.relations"})
    fs::create_symlink(shared_file(name).value(), data_ / name);
  const fs::path file = folder_.path() / "csail.json";
  ASSERT_EQ(run_program({"match", "--data", data_.string(), "--cases", "1", "--json", file.string()}), 0)
      << err_.str();
  const Json json = Json::parse(read_file(file));
  EXPECT_EQ(json["matchers"][0]["cases"], 2);
  EXPECT_EQ(json["logs"][0]["remark"], "");
  EXPECT_LT(json["logs"][0]["translation_error_m"], 0.05);
}

TEST_F(BenchApp, adds_false_loops_to_the_graph_of_a_log) {
  write_room();
  const fs::path json_file = folder_.path() / "false.json";
  const fs::path csv_file = folder_.path() / "false.csv";
  const fs::path output = folder_.path() / "out";
  ASSERT_EQ(run_program({"false-loops", "--data", data_.string(), "--ini", ini_.string(), "--shares",
                         "50,200", "--seeds", "2", "--json", json_file.string(), "--csv", csv_file.string(),
                         "-o", output.string()},
                        true),
            0)
      << err_.str();
  EXPECT_THAT(err_.str(), HasSubstr("mapping room"));
  EXPECT_EQ(out_.str(), read_file(output / "false-loops.md"));
  for (const char* kind : {"scattered", "groups", "nearby", "slips"})
    EXPECT_THAT(read_file(output / ("false-loops-" + std::string(kind) + ".svg")), HasSubstr("</svg>"));
  const Json json = Json::parse(read_file(json_file));
  EXPECT_THAT(out_.str(), HasSubstr(json["files"][0]["sha256"].get<std::string>()));
  ASSERT_EQ(json["rows"].size(), 7U);  // 200 % of the stretches cannot slip
  const std::string csv = read_file(csv_file);
  EXPECT_THAT(csv, HasSubstr(",undefended.translation_error_m.mean,"));
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 8);
  EXPECT_GT(json["logs"][0]["loops"], 10);
  for (const Json& row : json["rows"]) {
    EXPECT_EQ(row["seeds"], Json({1, 2}));
    if (row["kind"] != "slips") {
      EXPECT_EQ(row["undefended"]["false_kept"]["min"], row["false_loops"]);
    }
    EXPECT_LT(row["defended"]["translation_error_m"]["max"], 0.1);
  }
}

TEST_F(BenchApp, commands_name_missing_logs_and_relations) {
  write_room();
  const auto refused = [&](const std::vector<std::string>& options) {
    return refusal_of(words("false-loops", options));
  };
  EXPECT_THAT(refused({"--logs", "room,hall"}), HasSubstr("no log called hall"));
  EXPECT_THAT(refused({"--shares", "-1"}), HasSubstr("--shares"));
  EXPECT_THAT(refused({"--seeds", "0"}), HasSubstr("--seeds"));
  fs::remove(data_ / "room.relations");
  EXPECT_THAT(refused({}), HasSubstr("NAME.relations"));
  EXPECT_THAT(refused({"--logs", "room"}), HasSubstr("expected room.relations"));
}

TEST_F(BenchApp, wrong_usage_and_input_give_one_sentence_and_exit_code_2) {
  EXPECT_THAT(refusal({}), HasSubstr("there is no log in " + data_.string()));
  write_lines(data_ / "other.log", room_log_lines(2));
  EXPECT_THAT(refusal({"--bogus"}), HasSubstr("--bogus"));
  EXPECT_THAT(refusal({"--cases", "0"}), HasSubstr("--cases"));
  EXPECT_THAT(refusal({"--cases", "many"}), HasSubstr("--cases"));
  EXPECT_THAT(refusal({"--seed", "-1"}), HasSubstr("--seed"));
  EXPECT_THAT(refusal({"--json", folder_.path().string()}), HasSubstr("is a folder"));
  EXPECT_THAT(refusal({"--json", (folder_.path() / "no" / "a.json").string()}), HasSubstr("does not exist"));
  EXPECT_THAT(refusal({"-o", (data_ / "other.log").string()}), HasSubstr("other.log"));
  EXPECT_EQ(run_program({"match", "--data", (folder_.path() / "no").string()}), 2);
  EXPECT_THAT(err_.str(), HasSubstr("is not a folder"));
  EXPECT_EQ(run_program({}), 2);
  EXPECT_EQ(run_program({"match"}), 2);
  EXPECT_EQ(run_program({"--help"}), 0);
  EXPECT_EQ(run_program({"match", "--help"}), 0);
  EXPECT_THAT(out_.str(), HasSubstr("--parts"));
}

TEST_F(BenchApp, simulates_a_run_and_writes_it_as_a_log_with_its_truth) {
  const fs::path json_file = folder_.path() / "simulate.json";
  const fs::path output = folder_.path() / "out";
  const fs::path log = folder_.path() / "run.clf.gz";
  ASSERT_EQ(run_program({"simulate", "--path-m", "40", "--seed", "3", "--json", json_file.string(), "-o",
                         output.string(), "--write-log", log.string()},
                        true),
            0)
      << err_.str();
  EXPECT_THAT(err_.str(), HasSubstr("40 m"));
  EXPECT_EQ(out_.str(), read_file(output / "simulate.md"));
  for (const char* name : {"plan", "error", "time", "memory"})
    EXPECT_THAT(read_file(output / (std::string("simulate-") + name + ".svg")), HasSubstr("</svg>"));
  const Json simulated = Json::parse(read_file(json_file))["drives"][0];
  EXPECT_EQ(simulated["false_loops"], 0);
  EXPECT_LT(simulated["error_mean_m"], 0.3);
  EXPECT_GT(simulated["peak_memory_mib"], 10);

  const Trajectory truth = read_trajectory(folder_.path() / "run.tum");
  EXPECT_EQ(truth.size(), simulated["scans"]);
  const std::vector<Relation> relations = read_relations(folder_.path() / "run.relations");
  EXPECT_LT(evaluate_relations(truth, relations).translation_abs_m.max, 1e-4);
  const auto source = open_log(log, LogOptions());
  std::size_t frames = 0;
  while (const std::optional<Frame> frame = source->next()) {
    ASSERT_EQ(frame->time_us, truth[frames++].time_us);
    ASSERT_EQ(frame->scan.ranges_m.size(), 181U);
    ASSERT_NEAR(static_cast<double>(frame->scan.bearings_rad->front()), -M_PI / 2, 1e-4);
    ASSERT_NEAR(frame->scan.robot_T_laser.x, 0.1, 1e-6);
  }
  EXPECT_EQ(frames, truth.size());
}

TEST_F(BenchApp, refuses_impossible_simulations) {
  const std::vector<std::vector<std::string>> wrong = {
      {"--path-m", "5"},
      {"--path-m", "far"},
      {"--path-m", "nan"},
      {"--path-m", "40,nan"},
      {"--max-range-m", "nan"},
      {"--range-noise-m", "NAN"},
      {"--glass", "nan"},
      {"--glass", "1.5"},
      {"--people", "-1"},
      {"--path-m", "40", "--seed", "-1"},
      {"--write-log", (folder_.path() / "a.clf.gz").string()},
      {"--path-m", "40", "--write-log", (folder_.path() / "a.log").string()},
      {"--path-m", "40", "--json", folder_.path().string()}};
  for (std::vector<std::string> options : wrong) {
    options.insert(options.begin(), "simulate");
    EXPECT_EQ(run_program(options), 2) << options[1] << ' ' << options[2];
    EXPECT_THAT(err_.str(), MatchesRegex("psi-slam-bench: [^\n]+\n")) << "one line";
  }
}

TEST(WorkProgress, shows_the_time_left_once_it_can) {
  EXPECT_EQ(work_progress_text("intel", 0.25, 60), "intel    25 %   3:00 left");
  EXPECT_EQ(work_progress_text("intel", 0.001, 60), "intel     0 %");
}

}  // namespace
}  // namespace psi_slam
