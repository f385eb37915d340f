// SPDX-License-Identifier: BSD-3-Clause
// Tests whole sweeps of small logs, also with killed processes and interrupts.
#include <gmock/gmock.h>

#include <chrono>
#include <optional>
#include <regex>
#include <thread>

#include "../bench/room_benchmark.h"
#include "app_run.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kLongest{120};

class SweepCommand : public testing::Test {
 protected:
  SweepCommand() {
    write_room_benchmark(folder_.path(), folder_.path());
    write_lines(folder_.path() / "short.log", room_log_lines(60));
  }

  std::vector<std::string> words(const std::string& output, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all{"sweep",
                                 (folder_.path() / "room.log").string(),
                                 (folder_.path() / "short.log").string(),
                                 "-o",
                                 (folder_.path() / output).string(),
                                 "--set",
                                 "map.resolution_m=0.05,0.1",
                                 "--seeds",
                                 "2"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  AppRun sweep(const std::string& output, const std::vector<std::string>& more = {}) const {
    return AppProcess(words(output, more), folder_.path()).finish();
  }

  /// sweep.csv without its last three columns, which are times and memory.
  std::string table(const std::string& output) const {
    return std::regex_replace(bytes_of(folder_.path() / output / "sweep.csv"),
                              std::regex(",[^,\n]*,[^,\n]*,[^,\n]*\n"), "\n");
  }

  /// report.md up to the section with times.
  std::string page(const std::string& output) const {
    const std::string text = bytes_of(folder_.path() / output / "report.md");
    return text.substr(0, text.find("## Times"));
  }

  /// Waits until `ready` returns true. Returns false if that takes longer than kLongest.
  template <class Ready>
  static bool wait_for(const Ready& ready) {
    for (const auto began = Clock::now(); Clock::now() - began < kLongest;) {
      if (ready()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return false;
  }

  std::size_t finished(const std::string& output) const {
    const fs::path runs = folder_.path() / output / "runs";
    std::size_t count = 0;
    if (!fs::exists(runs)) return 0;
    for (const auto& entry : fs::directory_iterator(runs))
      count += entry.path().extension() != ".part" ? 1 : 0;
    return count;
  }

  TemporaryFolder folder_;
};

/// Ids of the child processes of `parent`. Empty if `parent` has ended.
std::vector<pid_t> children_of(pid_t parent) {
  std::vector<pid_t> children;
  std::error_code gone;
  for (const auto& task : fs::directory_iterator("/proc/" + std::to_string(parent) + "/task", gone)) {
    std::ifstream file(task.path() / "children");
    for (pid_t child = 0; file >> child;) children.push_back(child);
  }
  return children;
}

TEST_F(SweepCommand, makes_every_run_once) {
  const AppRun first = sweep("out", {"--processes", "2"});
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_THAT(first.out, HasSubstr("8 of 8 runs are finished, 8 made now"));
  EXPECT_EQ(finished("out"), 8U);
  EXPECT_THAT(page("out"), HasSubstr("| room | 0.05 | 2 | "));
  EXPECT_THAT(page("out"), HasSubstr("| short | 0.1 | 2 | – | – |")) << "it has no relations";
  const std::string csv = bytes_of(folder_.path() / "out" / "sweep.csv");
  const AppRun again = sweep("out");
  EXPECT_THAT(again.out, HasSubstr("0 made now"));
  EXPECT_EQ(bytes_of(folder_.path() / "out" / "sweep.csv"), csv) << "times, too";
  EXPECT_THAT(sweep("out", {"--keep", "maps"}).out, HasSubstr("8 made now")) << "the maps were not kept";
}

TEST_F(SweepCommand, warns_once_of_an_old_option_name) {
  const AppRun run = sweep("out", {"--set", "log.odometry_topic=none"});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(run.err, "psi-slam: --set: option log.odometry_topic was renamed; write log.odometry\n");
}

TEST_F(SweepCommand, runs_are_those_of_psi_slam_itself) {
  ASSERT_EQ(sweep("out", {"--keep", "maps"}).code, 0);
  const fs::path run = fs::directory_iterator(folder_.path() / "out" / "runs")->path();
  const std::string log = run.filename().string().rfind("room", 0) == 0 ? "room.log" : "short.log";
  const fs::path alone = folder_.path() / "alone";
  ASSERT_EQ(run_app({"-c", (run / "settings.ini").string(), (folder_.path() / log).string(), "-o",
                     alone.string(), "-q"})
                .code,
            0);
  for (const char* name : {"trajectory.tum", "map.pgm", "graph.g2o"})
    EXPECT_EQ(bytes_of(alone / name), bytes_of(run / name)) << name;
}

TEST_F(SweepCommand, survives_a_killed_worker) {
  ASSERT_EQ(sweep("undisturbed").code, 0);
  const AppProcess process(words("disturbed"), folder_.path());
  std::vector<pid_t> workers;
  ASSERT_TRUE(wait_for([&] {
    workers = children_of(process.pid());
    return !workers.empty();
  }));
  ASSERT_EQ(::kill(workers.front(), SIGKILL), 0);
  const AppRun run = process.finish();
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(table("disturbed"), table("undisturbed"));
  EXPECT_EQ(page("disturbed"), page("undisturbed"));
}

TEST_F(SweepCommand, resumes_a_killed_sweep_and_leaves_no_process) {
  ASSERT_EQ(sweep("undisturbed").code, 0);
  const AppProcess process(words("disturbed"), folder_.path());
  ASSERT_TRUE(wait_for([&] { return finished("disturbed") >= 2; }));
  ASSERT_TRUE(wait_for([&] { return !children_of(process.pid()).empty(); }));
  const pid_t worker = children_of(process.pid()).front();
  process.send(SIGKILL);
  process.finish();
  EXPECT_TRUE(wait_for([&] {
    std::string state = bytes_of("/proc/" + std::to_string(worker) + "/stat");
    return state.empty() || state[state.rfind(')') + 2] == 'Z';  // ended, or a zombie
  }));
  const std::size_t there = finished("disturbed");
  const AppRun rest = sweep("disturbed");
  ASSERT_EQ(rest.code, 0) << rest.err;
  EXPECT_THAT(rest.out, HasSubstr(std::to_string(8 - there) + " made now"));
  EXPECT_EQ(table("disturbed"), table("undisturbed"));
  EXPECT_EQ(finished("disturbed"), 8U);
}

TEST_F(SweepCommand, an_interrupt_keeps_and_reports_finished_runs) {
  const AppProcess process(words("out"), folder_.path());
  ASSERT_TRUE(wait_for([&] { return finished("out") >= 1; }));
  process.send(SIGINT);
  const AppRun run = process.finish();
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.err, HasSubstr("The same command resumes the sweep"));
  EXPECT_THAT(table("out"), HasSubstr(",to go,"));
  EXPECT_THAT(table("out"), HasSubstr(",done,"));
}

TEST_F(SweepCommand, a_log_that_cannot_be_mapped_does_not_stop_the_others) {
  write_bytes(folder_.path() / "short.log", "this is no log\n");
  const AppRun run = sweep("out");
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.err, HasSubstr("4 runs failed"));
  EXPECT_THAT(run.out, HasSubstr("4 of 8 runs are finished"));
  EXPECT_THAT(page("out"), HasSubstr("short.log"));
}

TEST_F(SweepCommand, two_sweeps_do_not_work_in_one_folder) {
  const AppProcess process(words("out"), folder_.path());
  ASSERT_TRUE(wait_for([&] { return !children_of(process.pid()).empty(); }));
  const AppRun other = run_app(words("out"));
  EXPECT_EQ(other.code, 2);
  EXPECT_THAT(other.err, HasSubstr("another sweep is running"));
  EXPECT_EQ(process.finish().code, 0);
}

TEST_F(SweepCommand, help_shows_no_internals) {
  const AppRun help = run_app({"sweep", "--help"});
  EXPECT_THAT(help.out, HasSubstr("--keep WHAT"));
  EXPECT_THAT(help.out, HasSubstr("--processes N"));
  for (const char* internal : {"->", "INT", "{", " in ["}) {
    const std::string options = help.out.substr(help.out.find("\nOptions:"));
    EXPECT_THAT(options, testing::Not(HasSubstr(internal)));
  }
}

TEST_F(SweepCommand, wrong_usage_gives_one_sentence) {
  EXPECT_THAT(run_app({"sweep", "-o", (folder_.path() / "out").string()}).err, HasSubstr("name the logs"));
  EXPECT_THAT(run_app({"sweep", (folder_.path() / "room.log").string()}).err, HasSubstr("-o DIR"));
  EXPECT_THAT(run_app(words("out", {"--seds", "1"})).err, HasSubstr("did you mean \"--seeds\""));
  EXPECT_THAT(run_app(words("out", {"--keep", "some"})).err, HasSubstr("expected none, paths or maps"));
  EXPECT_EQ(run_app(words("out", {"--processes", "0"})).code, 2);
  EXPECT_EQ(run_app(words("out", {"--seeds", "3-1"})).code, 2);
}

}  // namespace
}  // namespace psi_slam
