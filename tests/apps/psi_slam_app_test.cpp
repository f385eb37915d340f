// SPDX-License-Identifier: BSD-3-Clause
// Tests whole runs of psi-slam.
#include "psi_slam_app.h"

#include <gmock/gmock.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/serialization/CArchive.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "../session/room_log.h"
#include "app_run.h"
#include "map/trajectory/trajectory_file.h"
#include "pose_graph/g2o_file.h"
#include "psi_slam/time_stamp.h"
#include "same_results.h"
#include "shared_logs.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::MatchesRegex;
using testing::Not;
using Json = nlohmann::json;

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename().string());
  return names;
}

std::set<std::string> all_result_names() {
  return {result_names().begin(), result_names().end()};
}

class PsiSlamApp : public testing::Test {
 protected:
  /// Maps the log into the folder `name`.
  AppRun map(const std::string& log, const std::string& name, std::vector<std::string> options = {}) {
    options.insert(options.end(), {log, "-o", output(name).string()});
    return run_app(options);
  }

  fs::path output(const std::string& name) const { return folder_.path() / name; }

  /// Expects equal results of two runs, except times and other entries that may differ.
  void expect_same_bytes(const std::string& a, const std::string& b) const {
    expect_same_results(output(a), output(b));
  }

  std::string room_log(int scans = 60) {
    return write_lines(folder_.path() / "room.log", room_log_lines(scans)).string();
  }

  TemporaryFolder folder_;
};

TEST_F(PsiSlamApp, says_which_readings_of_the_robot_itself_it_ignores) {
  std::vector<std::string> lines = room_log_lines(150);
  for (std::string& line : lines) line = with_ranges(line, 20, 28, "0.35");
  const std::string log = write_lines(folder_.path() / "mast.log", lines).string();
  const std::string sentence =
      "the laser at x 0.00 m, y 0.00 m sees the robot itself in 8.0 degrees (8 beams from -70.0 to -63.0 "
      "degrees at 0.35 m), so these readings are ignored. Keep them with log.mask_own_body=off";
  const AppRun run = map(log, "masked");
  EXPECT_EQ(run.code, 0);
  EXPECT_THAT(run.err, HasSubstr("psi-slam: " + sentence + "\n"));
  EXPECT_THAT(bytes_of(output("masked") / "report.html"), HasSubstr(sentence));
  EXPECT_THAT(Json::parse(bytes_of(output("masked") / "summary.json"))["warnings"],
              testing::Contains(sentence));
  EXPECT_THAT(map(log, "unmasked", {"--set", "log.mask_own_body=off"}).err, Not(HasSubstr("itself")));
}

TEST_F(PsiSlamApp, maps_the_quickstart_log) {
  if (!fs::exists(kQuickstartLog)) GTEST_SKIP() << kNeedsQuickstartLog;
  const AppRun run = map(kQuickstartLog, "out");
  EXPECT_EQ(run.code, 0);
  EXPECT_EQ(run.err, "");
  EXPECT_THAT(run.out, AllOf(HasSubstr((output("out") / "map.png").string()), HasSubstr("report.html"),
                             HasSubstr("225 scans"), HasSubstr("real-time factor")));
  EXPECT_EQ(names_in(output("out")), all_result_names());

  EXPECT_EQ(read_trajectory(output("out") / "trajectory.tum").size(), 225U);
  EXPECT_EQ(read_trajectory(output("out") / "trajectory.carmen").size(), 225U);
  const Json summary = Json::parse(bytes_of(output("out") / "summary.json"));
  EXPECT_EQ(summary["log"]["scans"], 225);
  const PoseGraphFile graph = read_pose_graph(output("out") / "graph.g2o");
  EXPECT_EQ(graph.graph.num_nodes(), summary["nodes"]);
  mrpt::maps::COccupancyGridMap2D grid;
  EXPECT_TRUE(grid.loadFromROSMapServerYAML((output("out") / "map.yaml").string()));
  EXPECT_GT(grid.getSizeX(), 100U);
  mrpt::io::CFileGZInputStream grid_file((output("out") / "map.gridmap.gz").string());
  EXPECT_NO_THROW(mrpt::serialization::archiveFrom(grid_file) >> grid);
  mrpt::maps::CSimpleMap simple_map;
  EXPECT_TRUE(simple_map.loadFromFile((output("out") / "map.simplemap.gz").string()));
  EXPECT_EQ(simple_map.size(), summary["nodes"]);
  EXPECT_EQ(bytes_of(output("out") / "map.png").substr(1, 3), "PNG");
  EXPECT_THAT(bytes_of(output("out") / "report.html"), HasSubstr("</html>"));
}

TEST_F(PsiSlamApp, gives_the_same_bytes_with_any_number_of_threads) {
  if (!fs::exists(kQuickstartLog)) GTEST_SKIP() << kNeedsQuickstartLog;
  const std::string gpkg = "map.write_gpkg=true";
  ASSERT_EQ(map(kQuickstartLog, "first", {"--threads", "1", "--set", gpkg}).code, 0);
  ASSERT_EQ(map(kQuickstartLog, "again", {"--threads", "1", "--set", gpkg}).code, 0);
  ASSERT_EQ(map(kQuickstartLog, "two", {"--threads", "2", "--set", gpkg}).code, 0);
  expect_same_bytes("first", "again");
  expect_same_bytes("first", "two");
}

TEST_F(PsiSlamApp, gives_the_same_bytes_of_a_benchmark_log_with_one_and_two_threads) {
  const auto log = shared_file("mit-csail.clf.gz");
  if (!log) GTEST_SKIP() << kNeedsData;
  const std::string ini = std::string(PSI_SLAM_INI_FOLDER) + "/mit-csail.ini";
  ASSERT_EQ(map(log->string(), "one", {"-c", ini, "--threads", "1"}).code, 0);
  ASSERT_EQ(map(log->string(), "two", {"-c", ini, "--threads", "2"}).code, 0);
  expect_same_bytes("one", "two");
}

TEST_F(PsiSlamApp, prints_the_summary_as_json) {
  const AppRun run = map(room_log(), "out", {"--json", "--seed", "7", "--set", "map.resolution_m=0.1"});
  EXPECT_EQ(run.code, 0);
  const Json summary = Json::parse(run.out);
  EXPECT_EQ(summary["log"]["scans"], 60);
  EXPECT_EQ(summary["settings"]["run.seed"], "7");
  EXPECT_EQ(summary["map"]["resolution_m"], 0.1);
  EXPECT_GT(summary["wall_s"], 0);
  EXPECT_EQ(summary["interrupted"], false);
  EXPECT_EQ(run.out, bytes_of(output("out") / "summary.json"));
}

TEST_F(PsiSlamApp, warns_if_the_map_is_coarser_than_requested) {
  const AppRun run = map(room_log(), "out", {"--json", "--set", "map.max_cells=20000"});
  EXPECT_EQ(run.code, 0);
  EXPECT_EQ(run.err, "psi-slam: map.max_cells limits the map to cells of 0.1 m instead of 0.05 m\n");
  const Json summary = Json::parse(run.out);
  EXPECT_EQ(summary["map"]["resolution_m"], 0.1);
  EXPECT_EQ(summary["map"]["asked_resolution_m"], 0.05);
}

TEST_F(PsiSlamApp, shows_its_progress_on_a_terminal_only) {
  const std::string log = room_log();
  const AppRun run = run_app({log, "-o", output("terminal").string()}, true);
  EXPECT_EQ(run.code, 0);
  EXPECT_THAT(run.err, AllOf(HasSubstr(" scans/s"), HasSubstr(" left"), HasSubstr("writing the results")));
  EXPECT_EQ(run.err.substr(run.err.size() - 4), "\r\x1b[K") << "the line is erased at the end";
  EXPECT_EQ(run_app({log, "-o", output("file").string()}, false).err, "");
  const AppRun quiet = run_app({log, "-o", output("quiet").string(), "-q"}, true);
  EXPECT_EQ(quiet.out + quiet.err, "");
}

TEST_F(PsiSlamApp, verbose_prints_changed_settings_and_times) {
  const AppRun run = map(room_log(), "out", {"-v", "--set", "log.max_range_m=40"});
  EXPECT_EQ(run.code, 0);
  EXPECT_THAT(run.err, AllOf(HasSubstr("log.max_range_m = 40\n"), HasSubstr("read log"), HasSubstr(" ± ")));
  EXPECT_THAT(run.err, Not(HasSubstr("min_range_m")));
}

TEST_F(PsiSlamApp, overrides_take_precedence_over_the_file) {
  const fs::path ini = folder_.path() / "my.ini";
  write_bytes(ini, "[run]\nseed = 3\n[log]\nevery_nth_scan = 2\n");
  const std::vector<std::string> options{"--json", "-c",        ini.string(), "--set", "log.every_nth_scan=3",
                                         "--set",  "run.seed=5"};
  const Json summary = Json::parse(map(room_log(), "out", options).out);
  EXPECT_EQ(summary["log"]["scans"], 20);
  EXPECT_EQ(summary["settings"]["run.seed"], "5");
}

TEST_F(PsiSlamApp, recognises_logs_by_content) {
  const std::string log = write_lines(folder_.path() / "room.rawlog", room_log_lines(30)).string();
  EXPECT_EQ(map(log, "out").code, 0);
}

TEST_F(PsiSlamApp, force_replaces_results_and_leaves_other_files_alone) {
  const std::string log = room_log(30);
  fs::create_directory(output("out"));
  write_bytes(output("out") / "map.png", "old");
  write_bytes(output("out") / "notes.txt", "mine");
  EXPECT_EQ(map(log, "out", {"--force"}).code, 0);
  EXPECT_NE(bytes_of(output("out") / "map.png"), "old");
  EXPECT_EQ(bytes_of(output("out") / "notes.txt"), "mine");
}

TEST_F(PsiSlamApp, an_interrupt_ends_the_mapping_with_a_map) {
  const std::string log = room_log(3000);
  const AppProcess process({log, "-o", output("out").string(), "--json"}, folder_.path());
  const auto began = std::chrono::steady_clock::now();
  while (!fs::exists(output("out")) && std::chrono::steady_clock::now() - began < std::chrono::seconds(60))
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  process.send(SIGINT);
  const AppRun run = process.finish();
  EXPECT_EQ(run.code, 0);
  const Json summary = Json::parse(run.out);
  EXPECT_EQ(summary["interrupted"], true);
  EXPECT_EQ(summary["last_pass_cut_short"], true);
  const std::size_t scans = summary["log"]["scans"];
  EXPECT_LT(scans, 3000U);
  EXPECT_THAT(run.err, MatchesRegex("psi-slam: interrupted: the map will show the " + std::to_string(scans) +
                                    " scans[^\n]+\n"))
      << "told once";
  EXPECT_EQ(names_in(output("out")), all_result_names());
  EXPECT_EQ(read_trajectory(output("out") / "trajectory.tum").size(), scans);
}

TEST_F(PsiSlamApp, an_interrupt_ends_the_calibration_without_a_map) {
  const std::string log = room_log(3000);
  const AppProcess process({log, "-o", output("out").string(), "--verbose", "--set", "log.calibrate=true"},
                           folder_.path());
  const auto began = std::chrono::steady_clock::now();
  while (bytes_of(folder_.path() / "stderr").empty() &&
         std::chrono::steady_clock::now() - began < std::chrono::seconds(60))
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  process.send(SIGINT);
  const AppRun run = process.finish();
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.err, HasSubstr("psi-slam: interrupted before " + fs::path(log).filename().string() +
                                 " was calibrated. Nothing was written\n"));
  EXPECT_FALSE(fs::exists(output("out")));
}

TEST_F(PsiSlamApp, reports_a_full_output_folder_and_missing_edits_before_the_calibration) {
  const std::string log = room_log(100);
  fs::create_directories(output("out"));
  write_file(output("out") / "notes.txt", "full");
  const std::vector<std::string> calibrating{log, "-o", output("out").string(), "--set",
                                             "log.calibrate=true"};
  const AppRun full = run_app(calibrating, true);
  EXPECT_THAT(full.err, HasSubstr("is not empty"));
  EXPECT_EQ(full.err.find("calibrating"), std::string::npos);
  std::vector<std::string> edited = calibrating;
  edited.insert(edited.end(), {"--force", "--edits", output("missing.edits").string()});
  const AppRun missing = run_app(edited, true);
  EXPECT_THAT(missing.err, HasSubstr("missing.edits"));
  EXPECT_EQ(missing.err.find("calibrating"), std::string::npos);
}

TEST_F(PsiSlamApp, shows_the_progress_of_a_calibration) {
  const std::string log = room_log(100);
  const auto err = [&](bool is_terminal) {
    return run_app({log, "-o", output("out").string(), "--force", "--set", "log.calibrate=true"}, is_terminal)
        .err;
  };
  EXPECT_THAT(err(true), HasSubstr("calibrating " + fs::path(log).filename().string() + "   "));
  EXPECT_EQ(err(false).find("calibrating"), std::string::npos);
}

TEST_F(PsiSlamApp, applies_a_file_of_edits) {
  const std::string log = room_log(150);
  ASSERT_EQ(map(log, "as_it_is").code, 0);
  std::istringstream loops(bytes_of(output("as_it_is") / "loops.csv"));
  std::string edits;
  int deleted = 0;
  for (std::string row; std::getline(loops, row);) {
    const auto comma = [&](std::size_t from) { return row.find(',', from) + 1; };
    if (row.find(",accepted,") == std::string::npos) continue;
    const std::string scan = row.substr(0, row.find(','));
    const std::size_t map_at = comma(comma(0));
    ++deleted;
    edits +=
        "delete scan=" + scan + " local_map=" + row.substr(map_at, row.find(',', map_at) - map_at) + '\n';
  }
  ASSERT_FALSE(edits.empty());
  const std::string file = (folder_.path() / "mine.edits").string();
  write_bytes(file, edits + "force scan=149 local_map=99\n");
  const AppRun run = map(log, "edited", {"--edits", file});
  EXPECT_EQ(run.code, 0);
  EXPECT_THAT(run.err,
              HasSubstr("psi-slam: an edit was not made: force the loop of scan 149 with local map 99"));
  const Json summary = Json::parse(bytes_of(output("edited") / "summary.json"));
  EXPECT_LT(summary["loop_counts"]["accepted"], 0.2 * deleted) << "other loops may be found without those";
  EXPECT_GT(summary["loop_counts"]["by_hand"], 0);
  EXPECT_THAT(bytes_of(output("edited") / "loops.edits"), HasSubstr("delete scan="));
  EXPECT_THAT(bytes_of(output("edited") / "report.html"), HasSubstr("edited by hand"));
  EXPECT_NE(bytes_of(output("edited") / "graph.g2o"), bytes_of(output("as_it_is") / "graph.g2o"));
}

TEST_F(PsiSlamApp, rejects_a_file_without_edits) {
  const std::string file = (folder_.path() / "mine.edits").string();
  write_bytes(file, "forget scan=1 local_map=0\n");
  const AppRun run = map(room_log(), "out", {"--edits", file});
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(
      run.err,
      HasSubstr("mine.edits:1: unknown edit \"forget\": expected delete, force, match, restore, erase"));
  EXPECT_FALSE(fs::exists(output("out")));
}

}  // namespace
}  // namespace psi_slam
