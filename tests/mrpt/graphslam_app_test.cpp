// SPDX-License-Identifier: BSD-3-Clause
#include "graphslam_app.h"

#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

#include "../session/room_log.h"
#include "map/trajectory/trajectory_file.h"
#include "simulated_rawlog.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using ::testing::HasSubstr;

struct AppRun {
  int code = -1;
  std::string out;
  std::string err;
};

AppRun run_app(const std::vector<std::string>& arguments) {
  std::ostringstream out;
  std::ostringstream err;
  const int code = run_graphslam_app(arguments, out, err);
  return {code, out.str(), err.str()};
}

const std::string kIni = PSI_SLAM_INI_FOLDER "/graphslam.ini";

TEST(GraphSlamApp, the_program_maps_a_simulated_log_without_a_display) {
  const TemporaryFolder folder;
  const auto log = write_rawlog(folder.path() / "drive.rawlog", simulated_drive().frames, 1);
  const auto results = folder.path() / "results";
  const std::string command = "env -u DISPLAY " PSI_GRAPHSLAM_PROGRAM " -i " + kIni + " -r " + log.string() +
                              " --output-dir " + results.string() + " > /dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0);
  EXPECT_LT(simulated_drive().error_m(read_trajectory(results / "trajectory.tum")), 0.035);
  for (const char* name : {"output_graph.graph", "output_map.png", "summary.json", "CGraphSlamEngine.log"})
    EXPECT_TRUE(std::filesystem::exists(results / name)) << name;
}

TEST(GraphSlamApp, deciders_that_do_not_go_together_are_wrong_usage) {
  const TemporaryFolder folder;
  std::vector<Frame> frames = simulated_drive().frames;
  frames.resize(5);
  const std::string log = write_rawlog(folder.path() / "drive.rawlog", frames, 1).string();
  const AppRun run = run_app({"-i", kIni, "-r", log, "-n", "CICPCriteriaNRD", "--disable-visuals",
                              "--output-dir", (folder.path() / "results").string()});
  EXPECT_EQ(run.code, 2);
  EXPECT_EQ(run.err,
            "psi-graphslam: the edge decider CPsiLoopCloserERD needs the local maps of CPsiFrontEndNRD. "
            "Choose it as the node decider, or choose another edge decider.\n");
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "results"));
}

/// Returns the names of all files in a folder, including hidden files.
std::set<std::string> names_in(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& file : std::filesystem::directory_iterator(folder))
    names.insert(file.path().filename().string());
  return names;
}

const std::set<std::string>& result_names() {
  static const std::set<std::string> kNames{
      "CGraphSlamEngine.log", "edge_registrar.log", "node_registrar.log",    "optimizer.log",
      "output_graph.graph",   "output_map.png",     "output_map_limits.txt", "summary.json",
      "timings.log",          "trajectory.tum"};
  return kNames;
}

TEST(GraphSlamApp, a_damaged_log_is_mapped_up_to_the_damage_with_exit_code_2) {
  const TemporaryFolder folder;
  const auto log = write_rawlog(folder.path() / "drive.rawlog", simulated_drive().frames, 1);
  std::string bytes = read_file(log);
  bytes.replace(bytes.size() / 2, 1000, 1000, '?');
  write_file(log, bytes);
  const auto results = folder.path() / "results";
  const AppRun run =
      run_app({"-i", kIni, "-r", log.string(), "--disable-visuals", "--output-dir", results.string()});
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err, HasSubstr(log.string() + ": object "));
  EXPECT_THAT(run.err, HasSubstr("the map shows the "));
  EXPECT_EQ(names_in(results), result_names());
  const Trajectory path = read_trajectory(results / "trajectory.tum");
  EXPECT_GT(path.size(), simulated_drive().frames.size() / 3);
  EXPECT_LT(path.size(), simulated_drive().frames.size() / 2 + 2);
  EXPECT_LT(simulated_drive().error_m(path), 0.1);
  EXPECT_THAT(read_file(results / "summary.json"), HasSubstr("\"broken_off\": \""));
}

TEST(GraphSlamApp, a_damaged_line_without_utf8_is_reported) {
  const TemporaryFolder folder;
  const auto log = write_lines(folder.path() / "room.log", room_log_lines(20));
  std::ofstream(log, std::ios::app) << "FLASER \xff\xfe 181 1.0";
  const auto results = folder.path() / "results";
  const AppRun run =
      run_app({"-i", kIni, "-r", log.string(), "--disable-visuals", "--output-dir", results.string()});
  EXPECT_EQ(run.code, 2) << run.err;
  const std::string summary = read_file(results / "summary.json");
  EXPECT_THAT(summary, HasSubstr("\"broken_off\": \""));
  EXPECT_THAT(summary, HasSubstr("\xef\xbf\xbd")) << "the replacement character stands for the invalid bytes";
}

TEST(GraphSlamApp, an_interrupted_run_writes_what_it_has) {
  const TemporaryFolder folder;
  const auto log = write_rawlog(folder.path() / "drive.rawlog", simulated_drive().frames, 1);
  for (const std::string signal : {"INT", "TERM"}) {
    const auto results = folder.path() / signal;
    const auto words = folder.path() / (signal + ".words");
    // The program creates the folder for the results when mapping begins.
    const std::string command = "bash -c '" PSI_GRAPHSLAM_PROGRAM " -i " + kIni + " -r " + log.string() +
                                " --disable-visuals --output-dir " + results.string() + " > /dev/null 2> " +
                                words.string() + " & while [ ! -d " + results.string() +
                                " ] && kill -0 $!; do sleep 0.01; done; kill -" + signal + " $!; wait $!'";
    EXPECT_EQ(std::system(command.c_str()), 0) << signal;
    EXPECT_THAT(read_file(words), HasSubstr("psi-graphslam: interrupted: the map will show the ")) << signal;
    EXPECT_THAT(read_file(results / "summary.json"), HasSubstr("\"interrupted\": true"));
    EXPECT_LT(read_trajectory(results / "trajectory.tum").size(), simulated_drive().frames.size());
  }
}

TEST(GraphSlamApp, a_full_disk_leaves_no_partial_map) {
  const TemporaryFolder folder;
  std::vector<Frame> frames = simulated_drive().frames;
  frames.resize(9);
  const auto log = write_rawlog(folder.path() / "drive.rawlog", frames, 1);
  const auto results = folder.path() / "results";
  const auto words = folder.path() / "words";
  const std::string command = "bash -c 'ulimit -f 1; " PSI_GRAPHSLAM_PROGRAM " -i " + kIni + " -r " +
                              log.string() + " --disable-visuals --output-dir " + results.string() +
                              " > /dev/null 2> " + words.string() + '\'';
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 1);
  EXPECT_THAT(read_file(words),
              HasSubstr("psi-graphslam: cannot write " + (results / "output_map.png").string() + ": "));
  EXPECT_THAT(names_in(results),
              ::testing::IsSubsetOf(std::set<std::string>{"output_graph.graph", "trajectory.tum"}));
}

TEST(GraphSlamApp, reports_scans_that_cannot_be_matched) {
  const TemporaryFolder folder;
  std::vector<Frame> frames = simulated_drive().frames;
  frames.resize(40);
  const auto log = write_rawlog(folder.path() / "drive.rawlog", frames, 1);
  std::string settings = read_file(kIni);
  const std::string distance = "front_end.node_distance_m = 0.15";
  settings.replace(settings.find(distance), distance.size(), distance + "\nlog.max_range_m = 0.2");
  write_file(folder.path() / "my.ini", settings);
  const AppRun run = run_app({"-i", (folder.path() / "my.ini").string(), "-r", log.string(),
                              "--disable-visuals", "--output-dir", (folder.path() / "results").string()});
  EXPECT_EQ(run.code, 0);
  EXPECT_THAT(run.err, HasSubstr("39 of 40 scans could not be matched"));
}

TEST(GraphSlamApp, reports_wrong_arguments) {
  EXPECT_THAT(run_app({"-r", "x"}).err, HasSubstr("-i INI"));
  EXPECT_THAT(run_app({"-i", kIni}).err, HasSubstr("-r LOG"));
  EXPECT_THAT(run_app({"-i", kIni, "-r", "/no/such.rawlog"}).err, HasSubstr("/no/such.rawlog"));
  EXPECT_THAT(run_app({"-i", "/no/such.ini", "-r", "x"}).err, HasSubstr("/no/such.ini"));
  EXPECT_THAT(run_app({"-i", kIni, "-r", "x", "--3d"}).err, HasSubstr("graphslam-engine"));
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{}, {"--no-such"}, {"-i", kIni, "-r", "/no/such.rawlog"}})
    EXPECT_EQ(run_app(words).code, 2);
}

TEST(GraphSlamApp, lists_deciders_and_optimizers) {
  const AppRun run = run_app({"--list-deciders"});
  EXPECT_EQ(run.code, 0);
  for (const char* name : {"CPsiFrontEndNRD (psi-slam)", "CFixedIntervalsNRD (MRPT)", "CLoopCloserERD (MRPT)",
                           "CPsiLoopCloserERD (psi-slam)", "CPsiSpaGSO (psi-slam)", "CLevMarqGSO (MRPT)"})
    EXPECT_THAT(run.out, HasSubstr(name));
  EXPECT_EQ(run_app({"--list-node-regs"}).out.find("ERD (MRPT)"), std::string::npos);
}

TEST(GraphSlamApp, prints_options_as_a_settings_file) {
  const TemporaryFolder folder;
  const AppRun run = run_app({"--dump-options"});
  EXPECT_THAT(run.out, HasSubstr("front_end.node_distance_m = 0.15"));
}

TEST(GraphSlamApp, reports_ground_truth_with_too_few_poses) {
  const TemporaryFolder folder;
  std::vector<Frame> frames = simulated_drive().frames;
  frames.resize(9);
  const std::string log = write_rawlog(folder.path() / "drive.rawlog", frames, 1).string();
  const auto run_with = [&](const std::string& poses) {
    write_file(folder.path() / "truth.txt", poses);
    return run_app({"-i", kIni, "-r", log, "-g", (folder.path() / "truth.txt").string(), "--disable-visuals",
                    "--output-dir", (folder.path() / "results").string()});
  };
  EXPECT_THAT(run_with("1 0 0 0\n2 0 0 0\n").err, HasSubstr("ends after 2 poses"));
  EXPECT_THAT(run_with("1 0 zero 0\n").err, HasSubstr("truth.txt:1"));
}

}  // namespace
}  // namespace psi_slam
