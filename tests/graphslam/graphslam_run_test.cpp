// SPDX-License-Identifier: BSD-3-Clause
// Whole runs of MRPT's engine: our deciders among each other, and with MRPT's.
#include "psi_slam/graphslam/graphslam_run.h"

#include <gmock/gmock.h>

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

Outcome run_team(const Team& team, int form = 1, int threads = 0) {
  const TemporaryFolder folder;
  const std::filesystem::path ini = folder.path() / "my.ini";
  std::string settings = read_file(PSI_SLAM_INI_FOLDER "/graphslam.ini");
  const std::string as_shipped = "run.threads = 0";
  settings.replace(settings.find(as_shipped), as_shipped.size(), "run.threads = " + std::to_string(threads));
  write_file(ini, settings);
  GraphSlamSetup setup;
  setup.ini = ini;
  setup.log = write_rawlog(folder.path() / "drive.rawlog", simulated_drive().frames, form);
  setup.node_decider = team.node;
  setup.edge_decider = team.edge;
  setup.optimizer = team.optimizer;
  GraphSlamRun run(setup, DeciderCatalogue());
  while (run.step()) {
  }
  run.finish();
  const OutputFolder output = OutputFolder::prepare(folder.path() / "out", false);
  run.write(output);
  Outcome outcome;
  outcome.error_m = simulated_drive().error_m(run.trajectory());
  outcome.poses = run.trajectory().size();
  outcome.nodes = run.graph().nodes.size();
  const auto counts = run.edge_counts();
  if (counts.count("LC") != 0) outcome.loops = counts.at("LC");
  outcome.graph = read_file(output.path() / "output_graph.graph");
  outcome.path = read_file(output.path() / "trajectory.tum");
  outcome.map = read_file(output.path() / "output_map.png");
  return outcome;
}

TEST(GraphSlamRun, ours_find_loops_and_the_truth) {
  const Outcome outcome = run_team({});
  EXPECT_EQ(outcome.poses, simulated_drive().frames.size());
  EXPECT_GT(outcome.loops, 10);
  EXPECT_LT(outcome.error_m, 0.03);
  EXPECT_GT(simulated_drive().odometry_error_m(), 10 * outcome.error_m);
  EXPECT_GT(outcome.map.size(), 1000U);
}

TEST(GraphSlamRun, observations_one_by_one_give_the_same_map_as_actions) {
  const Outcome actions = run_team({}, 1);
  const Outcome observations = run_team({}, 2);
  EXPECT_EQ(observations.poses, actions.poses);
  EXPECT_EQ(observations.nodes, actions.nodes);
  EXPECT_LT(observations.error_m, 0.03);
}

TEST(GraphSlamRun, the_same_seed_gives_the_same_bytes_on_any_number_of_threads) {
  const Outcome one = run_team({}, 1, 1);
  const Outcome again = run_team({}, 1, 3);
  EXPECT_TRUE(one.graph == again.graph);
  EXPECT_TRUE(one.path == again.path);
  EXPECT_TRUE(one.map == again.map);
  EXPECT_FALSE(one.graph.empty());
}

TEST(GraphSlamRun, our_optimizer_serves_the_deciders_of_others) {
  const Outcome outcome = run_team({"CFixedIntervalsNRD", "CEmptyERD", "CPsiSpaGSO"});
  EXPECT_EQ(outcome.poses, simulated_drive().frames.size());
  EXPECT_NEAR(outcome.error_m, simulated_drive().odometry_error_m(), 1e-4);
}

TEST(GraphSlamRun, our_node_decider_serves_others_edge_deciders_and_optimizers) {
  const Outcome front_end = run_team({"CPsiFrontEndNRD", "CEmptyERD", "CLevMarqGSO"});
  EXPECT_EQ(front_end.loops, 0);
  EXPECT_LT(front_end.error_m, 0.5 * simulated_drive().odometry_error_m());
}

TEST(GraphSlamRun, our_edge_decider_closes_loops_with_their_optimizer_too) {
  const Outcome outcome = run_team({"CPsiFrontEndNRD", "CPsiLoopCloserERD", "CLevMarqGSO"});
  EXPECT_GT(outcome.loops, 0);
  EXPECT_LT(outcome.error_m, 0.5 * simulated_drive().odometry_error_m());
}

TEST(GraphSlamRun, deciders_that_do_not_go_together_are_refused_in_one_sentence) {
  EXPECT_THAT(sentence_of([] {
                run_team({"CFixedIntervalsNRD", "CPsiLoopCloserERD", "CPsiSpaGSO"});
              }),
              HasSubstr("works with no other node decider"));
  EXPECT_THAT(sentence_of([] {
                run_team({"CPsiFrontEndNDR", "CEmptyERD", "CPsiSpaGSO"});
              }),
              HasSubstr("did you mean \"CPsiFrontEndNRD\"?"));
}

TEST(GraphSlamRun, a_mistake_within_the_engine_keeps_its_sentence) {
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
  GraphSlamRun run(setup, DeciderCatalogue());
  EXPECT_THAT(sentence_of([&] {
                while (run.step()) {
                }
              }),
              HasSubstr("tilted"));
}

}  // namespace
}  // namespace psi_slam
