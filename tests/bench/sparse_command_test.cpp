// SPDX-License-Identifier: BSD-3-Clause
#include <nlohmann/json.hpp>

#include "command_fixture.h"
#include "shared_logs.h"
#include "sparse/sparse_benchmark.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using Json = nlohmann::json;

constexpr const char* kRealLogs = "thinned,every-nth,sparse";

class SparseCommand : public BenchCommand {
 protected:
  SparseCommand() : BenchCommand("sparse") {}

  /// Writes the log of the room three times: as the dense log "room", as "mit-csail" for the part every-nth,
  /// and as the sparse log "hall".
  void write_rooms() const {
    write_room();
    fs::create_directories(data_ / "sparse");
    for (const char* ending : {".log", ".relations"}) {
      fs::copy_file(data_ / ("room" + std::string(ending)), data_ / ("mit-csail" + std::string(ending)));
      fs::copy_file(data_ / ("room" + std::string(ending)),
                    data_ / "sparse" / ("hall" + std::string(ending)));
    }
    fs::copy_file(ini_ / "room.ini", ini_ / "mit-csail.ini");
  }

  fs::path output_ = folder_.path() / "out" / "sparse";
  fs::path json_ = folder_.path() / "sparse.json";
};

TEST_F(SparseCommand, maps_every_log_and_writes_page_figures_and_pictures) {
  write_rooms();
  ASSERT_EQ(
      run({"--parts", kRealLogs, "--seeds", "2", "--json", json_.string(), "-o", output_.string()}, true), 0)
      << err_.str();
  EXPECT_THAT(err_.str(), HasSubstr("mit-csail, all scans")) << "the first line, however fast the others are";
  EXPECT_EQ(out_.str(), read_file(output_ / "sparse.md"));
  EXPECT_THAT(read_file(output_ / "sparse-hall.png"), StartsWith("\x89PNG"));
  EXPECT_FALSE(fs::exists(output_ / "sparse-room.png")) << "only maps of sparse logs";

  const Json rows = Json::parse(read_file(json_))["rows"];
  std::vector<std::string> cases;
  for (const Json& row : rows) {
    cases.push_back(row["log"].get<std::string>() + ", " + row["kept"].get<std::string>());
    EXPECT_EQ(row["seeds"], Json({1, 2}));
    EXPECT_GT(row["translation_abs_m"]["mean"], 0);
    EXPECT_LT(row["translation_abs_m"]["mean"], 0.15) << "the room is easy";
    EXPECT_EQ(row["floor_m"].is_null(), row["kept"] != "1 m / 0.5 rad");
    EXPECT_GE(row["node_ms"]["max"]["mean"], row["node_ms"]["p50"]["mean"]);
  }
  EXPECT_THAT(cases, testing::ElementsAre("mit-csail, 1 m / 0.5 rad", "room, 1 m / 0.5 rad",
                                          "mit-csail, 1 of 3", "mit-csail, 1 of 5", "hall, all"));
  EXPECT_LT(rows[1]["scans"]["mean"], 80) << "two rounds of 21 m";
  EXPECT_EQ(rows[2]["scans"]["mean"], 64);
  EXPECT_EQ(rows[4]["scans"]["mean"], 190);
  EXPECT_EQ(rows[1]["relations"]["mean"], 17) << "removed scans have poses";
}

TEST_F(SparseCommand, set_changes_an_option_of_all_runs) {
  write_rooms();
  ASSERT_EQ(
      run({"--parts", "sparse", "--seeds", "1", "--set", "log.every_nth_scan=2", "--json", json_.string()}),
      0)
      << err_.str();
  EXPECT_EQ(err_.str(), "") << "no terminal, no progress";
  EXPECT_EQ(Json::parse(read_file(json_))["rows"][0]["scans"]["mean"], 95);
  EXPECT_THAT(out_.str(), HasSubstr("default settings except `log.every_nth_scan=2`"));
}

TEST_F(SparseCommand, wrong_usage_and_input_give_one_sentence_and_exit_code_2) {
  EXPECT_THAT(refusal({}), HasSubstr("no log can be evaluated"));
  EXPECT_THAT(refusal_of({"sparse"}), HasSubstr("--data DIR"));
  write_rooms();
  EXPECT_THAT(refusal({"--parts", "some"}), HasSubstr("--parts"));
  EXPECT_THAT(refusal({"--seeds", "0"}), HasSubstr("--seeds"));
  EXPECT_THAT(refusal({"--logs", "garden"}), HasSubstr("no log called garden"));
  EXPECT_THAT(refusal({"--set", "log.bogus=1"}), HasSubstr("bogus"));
  EXPECT_THAT(refusal({"-o", (data_ / "room.log").string()}), HasSubstr("room.log"));
}

TEST(SparseBenchmark, floor_of_a_real_log_is_the_share_of_odometry) {
  const auto log = shared_file("mit-csail.clf.gz");
  const auto relations = shared_file("mit-csail.relations");
  const auto ini = shipped_ini_folder();
  if (!log || !relations || !ini) GTEST_SKIP() << kNeedsData;
  const BenchmarkLog csail{"mit-csail", *log, *ini / "mit-csail.ini", relations};
  const Settings settings = sparse_settings(csail, {}, 1);
  const double floor_m = thinned_floor_m(csail, settings, {});
  EXPECT_NEAR(floor_m, 0.054, 0.002);
  const SparseRow row = run_thinned(csail, settings, {});
  EXPECT_EQ(row.figures.scans, 419U);
  EXPECT_GT(row.figures.errors.translation_abs_m.mean, 0.9 * floor_m);
  EXPECT_LT(row.figures.errors.translation_abs_m.mean, 1.1 * floor_m);
}

}  // namespace
}  // namespace psi_slam
