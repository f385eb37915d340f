// SPDX-License-Identifier: BSD-3-Clause
#include "freiburg/freiburg_benchmark.h"

#include <gmock/gmock.h>

#include "psi_slam/user_error.h"
#include "room_benchmark.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

class FreiburgBenchmarks : public testing::Test {
 protected:
  FreiburgBenchmarks() {
    for (const fs::path& folder : {data_, ini_, output_ / "runs"}) fs::create_directories(folder);
    write_room_benchmark(data_, ini_);
    options_.matchers = {"csm", "ga"};
    options_.seeds = {1, 2};
    options_.output = output_;
    options_.program = PSI_SLAM_BENCH_PROGRAM;
  }

  FreiburgBenchmark run() {
    return run_freiburg_benchmark(find_benchmark_logs(data_, ini_), options_, stop_,
                                  [this](const std::string& doing, double done, double all) {
                                    EXPECT_LE(done, all);
                                    doing_ = doing;
                                  });
  }

  static std::size_t made(const FreiburgBenchmark& benchmark) {
    std::size_t count = 0;
    for (const FreiburgCell& cell : benchmark.cells)
      for (const FreiburgResult& result : cell.runs) count += result.made ? 1 : 0;
    return count;
  }

  /// All figures except times and memory, which differ from run to run.
  static std::string path_figures(const FreiburgBenchmark& benchmark) {
    std::string text;
    for (const FreiburgCell& cell : benchmark.cells)
      for (const FreiburgResult& result : cell.runs) {
        FreiburgFigures figures = result.figures.value();
        figures.wall_s = figures.cpu_s = figures.peak_memory_mib = 0;
        text += cell.log + ' ' + cell.matcher + ' ' + figures_json(figures) + '\n';
      }
    return text;
  }

  TemporaryFolder folder_;
  fs::path data_ = folder_.path() / "data";
  fs::path ini_ = folder_.path() / "ini";
  fs::path output_ = folder_.path() / "out";
  FreiburgOptions options_;
  std::atomic<bool> stop_{false};
  std::string doing_;
};

TEST_F(FreiburgBenchmarks, runs_csm_once_and_other_matchers_with_every_seed) {
  const FreiburgBenchmark benchmark = run();
  ASSERT_EQ(benchmark.cells.size(), 2U);
  EXPECT_EQ(benchmark.cells[0].runs.size(), 1U);
  EXPECT_EQ(benchmark.cells[1].runs.size(), 2U);
  EXPECT_EQ(benchmark.logs.at(0).sha256.size(), 64U);
  EXPECT_THAT(doing_, AllOf(HasSubstr("room-"), HasSubstr(" of 3 runs")));
  for (const FreiburgCell& cell : benchmark.cells)
    for (const FreiburgResult& result : cell.runs) {
      ASSERT_TRUE(result.figures) << result.failure;
      EXPECT_GT(result.figures->wall_s, 0);
      EXPECT_GT(result.figures->cpu_s, 0);
      EXPECT_GT(result.figures->peak_memory_mib, 5);
    }
}

TEST_F(FreiburgBenchmarks, kept_runs_are_not_repeated) {
  const FreiburgBenchmark first = run();
  EXPECT_EQ(made(first), 3U);
  const FreiburgBenchmark again = run();
  EXPECT_EQ(made(again), 0U);
  EXPECT_EQ(freiburg_report(again, options_, "m").markdown, freiburg_report(first, options_, "m").markdown)
      << "the times of the first runs are kept";
  options_.seeds = {1, 3};
  EXPECT_EQ(made(run()), 1U) << "the new seed";
  fs::remove(output_ / "runs" / "room-ga-2.json");
  write_file(output_ / "runs" / "room-ga-3.json", "{ cut short");
  EXPECT_EQ(made(run()), 2U);
}

TEST_F(FreiburgBenchmarks, runs_of_a_busier_machine_are_repeated) {
  options_.matchers = {"csm"};
  options_.processes = 2;
  run();
  options_.processes = 1;
  EXPECT_EQ(made(run()), 1U) << "its times were measured beside another run";
  options_.processes = 2;
  const FreiburgBenchmark again = run();
  EXPECT_EQ(made(again), 0U);
  EXPECT_THAT(freiburg_report(again, options_, "m").markdown, HasSubstr("at most 2 runs at a time"));
}

TEST_F(FreiburgBenchmarks, changed_inputs_repeat_the_runs) {
  options_.matchers = {"csm"};
  run();
  write_file(ini_ / "room.ini", "[front_end]\nnode_distance_m = 0.3\n");
  EXPECT_EQ(made(run()), 1U) << "settings";
  write_file(ini_ / "room.ini", "; a remark\n[front_end]\nnode_distance_m = 0.3\n");
  EXPECT_EQ(made(run()), 0U) << "the same settings in other words";
  write_room_benchmark(data_, ini_, 1.5);
  EXPECT_EQ(made(run()), 1U) << "relations";
  write_lines(data_ / "room.log", room_log_lines(191));
  EXPECT_EQ(made(run()), 1U) << "log";
}

TEST_F(FreiburgBenchmarks, two_processes_give_the_same_figures_as_one) {
  const std::string alone = path_figures(run());
  options_.processes = 2;
  options_.output = folder_.path() / "other";
  fs::create_directories(options_.output / "runs");
  EXPECT_EQ(path_figures(run()), alone);
}

TEST_F(FreiburgBenchmarks, reports_a_failed_run_and_continues_with_the_others) {
  write_lines(data_ / "blind.log",
              {with_ranges(room_log_lines(1).front(), 0, kRoomBeams, std::to_string(kRoomNoReturn_m))});
  write_file(ini_ / "blind.ini", "[log]\n");
  fs::copy(data_ / "room.relations", data_ / "blind.relations");
  options_.matchers = {"csm"};
  const FreiburgBenchmark benchmark = run();
  ASSERT_EQ(benchmark.cells.size(), 2U);
  EXPECT_EQ(benchmark.cells[0].log, "blind");
  EXPECT_FALSE(benchmark.cells[0].runs.at(0).figures);
  EXPECT_THAT(benchmark.cells[0].runs.at(0).failure, AllOf(HasSubstr("blind.log"), HasSubstr("return")));
  EXPECT_TRUE(benchmark.cells[1].runs.at(0).figures);
  const std::string page = freiburg_report(benchmark, options_, "m").markdown;
  EXPECT_THAT(page, HasSubstr("| blind | csm | failed: " + data_.string()));
  EXPECT_THAT(page, HasSubstr("- blind, csm, seed 1: failed: " + data_.string()));
  EXPECT_THAT(freiburg_report(benchmark, options_, "m").json, HasSubstr("\"reason\": \"" + data_.string()));
  EXPECT_EQ(made(run()), 1U) << "a failed run is repeated";
}

TEST_F(FreiburgBenchmarks, a_killed_run_has_failed) {
  const fs::path program = folder_.path() / "suicide.sh";
  write_file(program, "#!/bin/sh\nkill -KILL $$\n");
  fs::permissions(program, fs::perms::owner_all);
  options_.program = program;
  for (const FreiburgCell& cell : run().cells)
    for (const FreiburgResult& result : cell.runs)
      EXPECT_THAT(result.failure, HasSubstr("ended by a signal"));
}

TEST_F(FreiburgBenchmarks, a_run_that_cannot_be_started_has_failed) {
  options_.program = folder_.path() / "no_program";
  write_file(options_.program, "text");
  for (const FreiburgCell& cell : run().cells)
    for (const FreiburgResult& result : cell.runs) EXPECT_THAT(result.failure, HasSubstr("cannot start"));
}

TEST_F(FreiburgBenchmarks, keeps_finished_runs_after_an_interrupt) {
  options_.matchers = {"csm"};
  run();
  options_.matchers = {"csm", "ga"};
  stop_ = true;
  try {
    run();
    ADD_FAILURE() << "it was not interrupted";
  } catch (const SystemFailure& failure) {
    EXPECT_THAT(failure.what(), AllOf(HasSubstr("2 runs to go"), HasSubstr("runs")));
  }
  stop_ = false;
  EXPECT_EQ(made(run()), 2U);
}

}  // namespace
}  // namespace psi_slam
