// SPDX-License-Identifier: BSD-3-Clause
// A shell script takes the place of psi-slam, to test runs that crash, hang or write wrong files.
#include "batch/sweep_run.h"

#include <gmock/gmock.h>

#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

/// Script that writes the files of a successful run. Its fourth argument is the output folder.
constexpr const char* kGoodRun =
    "for f in graph.g2o frames.csv loops.csv trajectory.carmen map.png; do echo $f > \"$4/$f\"; done\n"
    "printf '0 0 0 0 0 0 0 1\\n1 1 0 0 0 0 0 1\\n' > \"$4/trajectory.tum\"\n"
    "echo '{\"interrupted\": false, \"log\": {\"scans\": 2, \"duration_s\": 1}, \"nodes\": 2,"
    " \"path_length_m\": 1, \"loop_counts\": {\"accepted\": 3, \"rejected\": 9}}'"
    " > \"$4/summary.json\"\n";

class SweepRunTest : public testing::Test {
 protected:
  SweepOrder order(const std::string& script) const {
    const fs::path program = folder_.path() / "program";
    write_file(program, "#!/bin/sh\necho begun >> " + begun_.string() + '\n' + script);
    fs::permissions(program, fs::perms::owner_all);
    return {program, folder_.path() / "a.log", {}, "[run]\nseed = 7\n", "key", folder_.path() / "runs" / "a"};
  }

  SweepOutcome outcome(const SweepOrder& order) const {
    return make_run(order, [] { return false; }).value();
  }

  std::size_t times_begun() const { return read_file(begun_).size() / std::string("begun\n").size(); }

  static std::vector<std::string> names_in(const fs::path& folder) {
    std::vector<std::string> names;
    if (!fs::exists(folder)) return names;
    for (const auto& entry : fs::directory_iterator(folder))
      names.push_back(entry.path().filename().string());
    return names;
  }

  TemporaryFolder folder_;
  fs::path begun_ = folder_.path() / "begun";
};

TEST_F(SweepRunTest, keeps_the_requested_files_and_is_not_repeated) {
  SweepOrder run = order(kGoodRun);
  EXPECT_FALSE(kept_outcome(run));
  const SweepOutcome made = outcome(run);
  EXPECT_EQ(made.failure, "");
  EXPECT_EQ(made.attempts, 1);
  EXPECT_EQ(made.figures.value().loops_accepted, 3U);
  EXPECT_FALSE(made.figures->has_errors);
  EXPECT_THAT(names_in(run.folder), UnorderedElementsAre("run.json", "summary.json", "settings.ini"));
  EXPECT_EQ(read_file(run.folder / "settings.ini"), run.settings);
  ASSERT_TRUE(kept_outcome(run));
  EXPECT_EQ(kept_outcome(run)->attempts, 0);
  EXPECT_EQ(kept_outcome(run)->figures->wall_s, made.figures->wall_s) << "restored to the last bit";
  run.keep = SweepKeep::kPaths;
  EXPECT_FALSE(kept_outcome(run)) << "the kept result lacks files that are requested now";
  outcome(run);
  EXPECT_TRUE(fs::exists(run.folder / "trajectory.tum"));
  EXPECT_FALSE(fs::exists(run.folder / "map.png"));
  run.keep = SweepKeep::kMaps;
  EXPECT_FALSE(kept_outcome(run));
  outcome(run);
  EXPECT_TRUE(fs::exists(run.folder / "map.png"));
  run.keep = SweepKeep::kNone;
  EXPECT_TRUE(kept_outcome(run)) << "a kept result may have more files than requested";
  run.key = "other";
  EXPECT_FALSE(kept_outcome(run));
}

TEST_F(SweepRunTest, evaluates_the_path_by_the_relations) {
  SweepOrder run = order(kGoodRun);
  run.relations = folder_.path() / "a.relations";
  write_file(run.relations, "0 1 0.75 0 0 0 0 0\n");
  const SweepFigures figures = outcome(run).figures.value();
  EXPECT_TRUE(figures.has_errors);
  EXPECT_DOUBLE_EQ(figures.errors.translation_abs_m.mean, 0.25);
  write_file(run.relations, "100 101 1 0 0 0 0 0\n");
  EXPECT_NE(outcome(run).failure, "") << "no relation lies within the time of the log";
}

TEST_F(SweepRunTest, a_run_that_is_killed_once_succeeds_in_the_second_attempt) {
  const SweepOrder run =
      order("[ $(wc -l < " + begun_.string() + ") -gt 1 ] || kill -KILL $$\n" + std::string(kGoodRun));
  const SweepOutcome made = outcome(run);
  EXPECT_TRUE(made.figures);
  EXPECT_EQ(made.attempts, 2);
}

TEST_F(SweepRunTest, a_run_that_crashes_twice_has_failed) {
  const SweepOrder run = order("kill -SEGV $$\n");
  const SweepOutcome made = outcome(run);
  EXPECT_FALSE(made.figures);
  EXPECT_THAT(made.failure, HasSubstr("ended by a signal"));
  EXPECT_EQ(times_begun(), 2U);
  EXPECT_THAT(names_in(run.folder.parent_path()), testing::IsEmpty());
}

TEST_F(SweepRunTest, wrong_input_is_tried_once) {
  const SweepOutcome made = outcome(order("echo 'psi-slam: the log is empty' >&2; exit 2\n"));
  EXPECT_EQ(made.failure, "the log is empty");
  EXPECT_EQ(times_begun(), 1U);
}

TEST_F(SweepRunTest, a_stopped_run_leaves_nothing) {
  const SweepOrder run = order("exec sleep 600\n");
  EXPECT_FALSE(make_run(run, [] { return true; }));
  EXPECT_THAT(names_in(run.folder.parent_path()), testing::IsEmpty());
}

TEST_F(SweepRunTest, a_run_without_a_readable_summary_is_a_failure) {
  EXPECT_NE(outcome(order("echo nonsense > \"$4/summary.json\"\n")).failure, "");
  EXPECT_NE(outcome(order("exit 0\n")).failure, "");
}

}  // namespace
}  // namespace psi_slam
