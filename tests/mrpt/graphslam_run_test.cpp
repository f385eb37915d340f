// SPDX-License-Identifier: BSD-3-Clause
// Tests complete runs of MRPT's graph-slam engine with deciders of psi-slam and MRPT.
#include "mrpt/graphslam_run.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "simulated_rawlog.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using ::testing::HasSubstr;

struct Team {
  std::string node = "CPsiFrontEndNRD";
  std::string edge = "CPsiLoopCloserERD";
  std::string optimizer = "CPsiSpaGSO";
};

struct Outcome {
  double error_m = 0;
  std::size_t poses = 0;
  std::size_t nodes = 0;
  int loops = 0;
  std::string graph;
  std::string path;
  std::string map;
};

/// Returns the shipped settings with the line `as_shipped` replaced by `line`.
std::string settings_with(const std::string& line, const std::string& as_shipped) {
  std::string settings = read_file(PSI_SLAM_INI_FOLDER "/graphslam.ini");
  return settings.replace(settings.find(as_shipped), as_shipped.size(), line);
}

/// Maps a log with these deciders and settings. `write_log` writes the log to the given file.
Outcome run_team(const Team& team, const std::string& settings,
                 const std::function<void(const std::filesystem::path&)>& write_log) {
  const TemporaryFolder folder;
  GraphSlamSetup setup;
  setup.ini = folder.path() / "my.ini";
  write_file(setup.ini, settings);
  setup.log = folder.path() / "drive.rawlog";
  write_log(setup.log);
  setup.node_decider = team.node;
  setup.edge_decider = team.edge;
  setup.optimizer = team.optimizer;
  const auto run = make_graphslam_run(setup, DeciderCatalogue());
  while (run->step()) {
  }
  run->finish();
  const OutputFolder output = OutputFolder::prepare(folder.path() / "out", false);
  run->write(output);
  Outcome outcome;
  outcome.error_m = simulated_drive().error_m(run->trajectory());
  outcome.poses = run->trajectory().size();
  outcome.nodes = run->graph().nodes.size();
  const auto counts = run->edge_counts();
  if (counts.count("LC") != 0) outcome.loops = counts.at("LC");
  outcome.graph = read_file(output.path() / "output_graph.graph");
  outcome.path = read_file(output.path() / "trajectory.tum");
  outcome.map = read_file(output.path() / "output_map.png");
  return outcome;
}

Outcome run_team(const Team& team, int form = 1, int threads = 0) {
  return run_team(team, settings_with("run.threads = " + std::to_string(threads), "run.threads = 0"),
                  [&](const auto& path) { write_rawlog(path, simulated_drive().frames, form); });
}

std::vector<Frame> first_third() {
  const std::vector<Frame>& all = simulated_drive().frames;
  return {all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.size() / 3)};
}

/// Maps the first third of the run, recorded with the lasers "right", "left" or both.
Outcome run_with_lasers(const Team& team, int form, const std::string& log_laser, bool right, bool left) {
  const std::vector<Frame> frames = first_third();
  const std::string node_distance = "front_end.node_distance_m = 0.15";
  return run_team(team, settings_with(node_distance + "\nlog.laser = " + log_laser, node_distance),
                  [&](const auto& path) { write_rawlog_of_lasers(path, frames, form, right, left); });
}

bool same_results(const Outcome& a, const Outcome& b) {
  return a.poses == b.poses && a.graph == b.graph && a.path == b.path && a.map == b.map;
}

TEST(GraphSlamRun, deciders_of_psi_slam_find_loops_and_true_poses) {
  const Outcome outcome = run_team({});
  EXPECT_EQ(outcome.poses, simulated_drive().frames.size());
  EXPECT_GT(outcome.loops, 10);
  EXPECT_LT(outcome.error_m, 0.035);
  EXPECT_GT(simulated_drive().odometry_error_m(), 10 * outcome.error_m);
  EXPECT_GT(outcome.map.size(), 1000U);
}

TEST(GraphSlamRun, observations_one_by_one_give_the_same_map_as_actions) {
  const Outcome actions = run_team({}, 1);
  const Outcome observations = run_team({}, 2);
  EXPECT_EQ(observations.poses, actions.poses);
  EXPECT_EQ(observations.nodes, actions.nodes);
  EXPECT_LT(observations.error_m, 0.035);
}

TEST(GraphSlamRun, the_same_seed_gives_the_same_bytes_on_any_number_of_threads) {
  const Outcome one = run_team({}, 1, 1);
  const Outcome again = run_team({}, 1, 3);
  EXPECT_TRUE(one.graph == again.graph);
  EXPECT_TRUE(one.path == again.path);
  EXPECT_TRUE(one.map == again.map);
  EXPECT_FALSE(one.graph.empty());
}

TEST(GraphSlamRun, the_optimizer_works_with_deciders_of_mrpt) {
  const Outcome outcome = run_team({"CFixedIntervalsNRD", "CEmptyERD", "CPsiSpaGSO"});
  EXPECT_EQ(outcome.poses, simulated_drive().frames.size());
  EXPECT_NEAR(outcome.error_m, simulated_drive().odometry_error_m(), 1e-4);
}

TEST(GraphSlamRun, the_node_decider_works_with_edge_deciders_and_optimizers_of_mrpt) {
  const Outcome front_end = run_team({"CPsiFrontEndNRD", "CEmptyERD", "CLevMarqGSO"});
  EXPECT_EQ(front_end.loops, 0);
  EXPECT_LT(front_end.error_m, 0.5 * simulated_drive().odometry_error_m());
}

TEST(GraphSlamRun, the_edge_decider_works_with_an_optimizer_of_mrpt) {
  const Outcome outcome = run_team({"CPsiFrontEndNRD", "CPsiLoopCloserERD", "CLevMarqGSO"});
  EXPECT_GT(outcome.loops, 0);
  EXPECT_LT(outcome.error_m, 0.5 * simulated_drive().odometry_error_m());
}

TEST(GraphSlamRun, refuses_deciders_that_do_not_work_together) {
  EXPECT_THAT(sentence_of([] {
                run_team({"CFixedIntervalsNRD", "CPsiLoopCloserERD", "CPsiSpaGSO"});
              }),
              HasSubstr("needs the local maps of CPsiFrontEndNRD"));
  EXPECT_THAT(sentence_of([] {
                run_team({"CPsiFrontEndNDR", "CEmptyERD", "CPsiSpaGSO"});
              }),
              HasSubstr("did you mean \"CPsiFrontEndNRD\"?"));
}

TEST(GraphSlamRun, a_user_error_passes_through_the_engine) {
  const TemporaryFolder folder;
  std::vector<Frame> frames = simulated_drive().frames;
  frames.resize(3);
  GraphSlamSetup setup;
  setup.ini = PSI_SLAM_INI_FOLDER "/graphslam.ini";
  setup.log = folder.path() / "drive.rawlog";
  {
    mrpt::io::CFileOutputStream file(setup.log.string());
    auto archive = mrpt::serialization::archiveFrom(file);
    const auto scan = range_observation(frames.front());
    scan->sensorPose.setYawPitchRoll(0, 1, 0);
    archive << odometry_observation(frames.front()) << *scan;
  }
  const auto run = make_graphslam_run(setup, DeciderCatalogue());
  EXPECT_THAT(sentence_of([&] {
                while (run->step()) {
                }
              }),
              HasSubstr("tilted"));
}

TEST(GraphSlamRun, all_deciders_use_the_first_of_two_lasers_or_the_named_one) {
  for (const Team& team : {Team(), Team{"CFixedIntervalsNRD", "CEmptyERD", "CPsiSpaGSO"}}) {
    for (const int form : {1, 2}) {
      const Outcome right = run_with_lasers(team, form, "\"\"", true, false);
      const Outcome left = run_with_lasers(team, form, "\"\"", false, true);
      EXPECT_FALSE(right.map == left.map);
      EXPECT_TRUE(same_results(run_with_lasers(team, form, "\"\"", true, true), right)) << team.node << form;
      EXPECT_TRUE(same_results(run_with_lasers(team, form, "left", true, true), left)) << team.node << form;
    }
  }
}

TEST(GraphSlamRun, two_lasers_are_one_frame_here_and_the_first_scan_for_mrpt) {
  for (const int form : {1, 2}) {
    const Outcome both = run_with_lasers({}, form, "all", true, true);
    EXPECT_EQ(both.poses, first_third().size());
    EXPECT_LT(both.error_m, 0.05);
    EXPECT_FALSE(both.graph == run_with_lasers({}, form, "right", true, true).graph);
  }
  const Team mrpts{"CFixedIntervalsNRD", "CEmptyERD", "CPsiSpaGSO"};
  EXPECT_TRUE(run_with_lasers(mrpts, 1, "all", true, true).map ==
              run_with_lasers(mrpts, 1, "right", true, true).map);
}

TEST(GraphSlamRun, a_damaged_log_gives_a_map_of_the_part_read) {
  for (const Team& team : {Team(), Team{"CFixedIntervalsNRD", "CICPCriteriaERD", "CLevMarqGSO"}}) {
    const TemporaryFolder folder;
    GraphSlamSetup setup;
    setup.ini = PSI_SLAM_INI_FOLDER "/graphslam.ini";
    setup.log = write_rawlog(folder.path() / "drive.rawlog", simulated_drive().frames, 1);
    std::filesystem::resize_file(setup.log, std::filesystem::file_size(setup.log) / 2);
    setup.node_decider = team.node;
    setup.edge_decider = team.edge;
    setup.optimizer = team.optimizer;
    const auto run = make_graphslam_run(setup, DeciderCatalogue());
    while (run->step()) {
    }
    EXPECT_FALSE(run->step());
    run->finish();
    ASSERT_TRUE(run->broken_off());
    EXPECT_THAT(*run->broken_off(), HasSubstr("the file ends within this object"));
    EXPECT_FALSE(run->interrupted());
    EXPECT_NEAR(static_cast<double>(run->scans()), static_cast<double>(simulated_drive().frames.size()) / 2,
                2);
    EXPECT_EQ(run->trajectory().size(), run->scans());
  }
}

TEST(GraphSlamRun, a_run_stopped_early_or_cut_short_is_interrupted) {
  const TemporaryFolder folder;
  GraphSlamSetup setup;
  setup.ini = PSI_SLAM_INI_FOLDER "/graphslam.ini";
  setup.log = write_rawlog(folder.path() / "drive.rawlog", simulated_drive().frames, 1);
  constexpr std::size_t kSteps = 200;
  const auto interrupted = [&](std::size_t steps, bool go_on_at_the_end) {
    const auto run = make_graphslam_run(setup, DeciderCatalogue());
    for (std::size_t i = 0; i < steps && run->step(); ++i) continue;
    run->finish([&](double) { return go_on_at_the_end; });
    EXPECT_EQ(run->trajectory().size(), std::min(steps, simulated_drive().frames.size()));
    return run->interrupted();
  };
  EXPECT_TRUE(interrupted(kSteps, true));
  EXPECT_TRUE(interrupted(std::numeric_limits<std::size_t>::max(), false));
  EXPECT_FALSE(interrupted(std::numeric_limits<std::size_t>::max(), true));
}

TEST(GraphSlamRun, a_log_without_scans_is_an_error) {
  const TemporaryFolder folder;
  GraphSlamSetup setup;
  setup.ini = PSI_SLAM_INI_FOLDER "/graphslam.ini";
  setup.log = write_rawlog(folder.path() / "drive.rawlog", simulated_drive().frames, 1);
  const auto run = make_graphslam_run(setup, DeciderCatalogue());
  EXPECT_THAT(sentence_of([&] { run->finish(); }), HasSubstr("no scan was read, so there is nothing to map"));
}

}  // namespace
}  // namespace psi_slam
