// SPDX-License-Identifier: BSD-3-Clause
#include "freiburg/baselines.h"

#include <gmock/gmock.h>

#include "baseline_files.h"
#include "psi_slam/user_error.h"
#include "room_benchmark.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

class BaselineBenchmarks : public testing::Test {
 protected:
  BaselineBenchmarks() {
    for (const fs::path& folder : {data_, output_ / "runs"}) fs::create_directories(folder);
    write_room_benchmark(data_, data_);
    install(standing_still(190));
    options_.output = output_;
  }

  void install(const std::string& script) { install_baseline(folder_.path(), baseline_kinds()[0], script); }

  BaselineResult run() {
    const std::vector<BaselineResult> results =
        run_baselines(baselines_in(folder_.path()).programs, find_benchmark_logs(data_, data_), options_,
                      stop_, [](const std::string&, double done, double all) { EXPECT_LE(done, all); });
    return results.at(0);
  }

  TemporaryFolder folder_;
  fs::path data_ = folder_.path() / "data";
  fs::path output_ = folder_.path() / "out";
  BaselineOptions options_;
  std::atomic<bool> stop_{false};
};

TEST_F(BaselineBenchmarks, kept_results_are_not_repeated) {
  const BaselineResult first = run();
  ASSERT_TRUE(first.figures) << first.failure;
  EXPECT_TRUE(first.made);
  const BaselineResult again = run();
  EXPECT_FALSE(again.made);
  EXPECT_EQ(again.figures.value().cpu_s, first.figures->cpu_s);
  EXPECT_EQ(again.figures->errors.translation_abs_m.mean, first.figures->errors.translation_abs_m.mean);
}

TEST_F(BaselineBenchmarks, changed_inputs_repeat_the_runs) {
  run();
  install(standing_still(190) + "\n# another one");
  EXPECT_TRUE(run().made) << "program";
  const fs::path config = folder_.path() / "share/mrpt/config_files" / baseline_kinds()[0].config;
  write_file(config, "[MappingApplication]\nlogOutput_dir=x\n[ICP]\nALFA = 0.9\n");
  EXPECT_TRUE(run().made) << "settings of the program";
  write_room_benchmark(data_, data_, 1.5);
  EXPECT_TRUE(run().made) << "relations";
  write_file(data_ / "room.ini", "[log]\nmax_range_m = 9\n");
  EXPECT_TRUE(run().made) << "settings of the reader";
  EXPECT_FALSE(run().made);
}

TEST_F(BaselineBenchmarks, a_run_that_did_not_finish_is_repeated_only_with_more_time) {
  install("exec sleep 600");
  options_.time_limit_s = 0.4;
  EXPECT_EQ(run().not_finished_in_s, 0.4);
  options_.time_limit_s = 0.2;
  const BaselineResult kept = run();
  EXPECT_FALSE(kept.made);
  EXPECT_EQ(kept.not_finished_in_s, 0.4) << "it did not finish in 0.4 s either";
  options_.time_limit_s = 0.5;
  EXPECT_TRUE(run().made);
}

TEST_F(BaselineBenchmarks, a_failed_run_is_repeated) {
  install("exit 3");
  EXPECT_EQ(run().failure, "ended with code 3");
  EXPECT_TRUE(run().made);
}

TEST_F(BaselineBenchmarks, keeps_no_result_of_interrupted_runs) {
  stop_ = true;
  EXPECT_THROW(run(), SystemFailure);
  stop_ = false;
  EXPECT_TRUE(run().made);
}

}  // namespace
}  // namespace psi_slam
