// SPDX-License-Identifier: BSD-3-Clause
#include "freiburg/baselines.h"

#include <gmock/gmock.h>

#include <cstdlib>

#include "baseline_files.h"
#include "room_benchmark.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

class BaselineRuns : public testing::Test {
 protected:
  BaselineRuns() {
    write_room_benchmark(folder_.path(), folder_.path());
    run_.log = {"room", folder_.path() / "room.log", folder_.path() / "room.ini",
                folder_.path() / "room.relations"};
    run_.folder = folder_.path() / "run";
    run_.time_limit_s = 600;
  }

  BaselineResult result_of(const std::string& script, std::size_t kind = 0) {
    install_baseline(folder_.path(), baseline_kinds()[kind], script);
    run_.baseline = baselines_in(folder_.path()).programs.at(0);
    return run_baseline(run_, [this] { return stop_; });
  }

  TemporaryFolder folder_;
  BaselineRun run_;
  bool stop_ = false;
};

TEST_F(BaselineRuns, evaluates_its_path_by_the_relations) {
  const BaselineResult result = result_of("[ -s \"$2\" ] || exit 1\n" + standing_still(190));
  ASSERT_TRUE(result.figures) << result.failure;
  EXPECT_EQ(result.log, "room");
  EXPECT_EQ(result.baseline, "icp-slam");
  EXPECT_EQ(result.figures->scans, 190U);
  EXPECT_EQ(result.figures->relations_used, 17U);
  EXPECT_GT(result.figures->errors.translation_abs_m.mean, 1) << "its path stands still";
  EXPECT_NEAR(result.figures->duration_s, 189 * 0.2, 1e-9);
  EXPECT_GT(result.figures->wall_s, 0);
  EXPECT_GT(result.figures->cpu_s, 0);
  EXPECT_GT(result.figures->peak_memory_mib, 0.1);
  EXPECT_FALSE(fs::exists(run_.folder / "log.rawlog")) << "it is large";
  EXPECT_THAT(read_file(run_.folder / "settings.ini"), HasSubstr((run_.folder / "output").string()));
}

TEST_F(BaselineRuns, reports_failures) {
  EXPECT_THAT(result_of("echo '==== MRPT exception ====' >&2\necho 'Message:  no odometry' >&2\n"
                        "echo '[0 ] 0x7fa9' >&2\nexit 255")
                  .failure,
              "no odometry");
  EXPECT_THAT(result_of("kill -SEGV $$").failure, HasSubstr("ended by a signal"));
  EXPECT_THAT(result_of("").failure, HasSubstr("wrote no path"));
  EXPECT_THAT(result_of(standing_still(7)).failure, HasSubstr("7 poses for 190 scans"));
  EXPECT_THAT(result_of(standing_still(191)).failure, HasSubstr("steps 0 to 189"));
  EXPECT_THAT(result_of(standing_still(190, "0 here 0")).failure,
              HasSubstr("path.txt:1: expected the columns step"));
}

TEST_F(BaselineRuns, is_killed_at_its_time_limit) {
  run_.time_limit_s = 0.3;
  const BaselineResult result = result_of("exec sleep 600");
  EXPECT_EQ(result.not_finished_in_s, 0.3);
  EXPECT_FALSE(result.figures);
  EXPECT_EQ(result.failure, "");
}

TEST_F(BaselineRuns, is_interrupted_on_request) {
  stop_ = true;
  EXPECT_EQ(result_of("exec sleep 600").failure, "interrupted");
}

TEST_F(BaselineRuns, reads_the_yaw_from_the_column_of_the_program) {
  const fs::path file = folder_.path() / "path.txt";
  write_file(file, "0 1 2 0 0.5 0 0 10\n1 3 4 0 0.75 0 0 11\n");
  const Trajectory path = read_baseline_path(file, baseline_kinds()[1].yaw_column, {10, 20});
  ASSERT_EQ(path.size(), 2U);
  EXPECT_EQ(path[1].time_us, 20);
  EXPECT_EQ(path[1].pose, mrpt::math::TPose2D(3, 4, 0.75));
}

TEST_F(BaselineRuns, installed_baselines_map_the_room) {
  const char* const search_path = std::getenv("PATH");
  const FoundBaselines found = find_baselines(search_path != nullptr ? search_path : "");
  if (found.programs.empty()) GTEST_SKIP() << "needs icp-slam or rbpf-slam: Debian's package mrpt-apps";
  for (const BaselineProgram& baseline : found.programs) {
    SCOPED_TRACE(baseline.kind.name);
    run_.baseline = baseline;
    const BaselineResult result = run_baseline(run_, [] { return false; });
    ASSERT_TRUE(result.figures) << result.failure;
    EXPECT_THAT(baseline.version, HasSubstr("MRPT "));
    EXPECT_LT(result.figures->errors.translation_abs_m.mean, 0.3) << "the room is easy";
    EXPECT_GT(result.figures->errors.translation_abs_m.mean, 0);
  }
}

}  // namespace
}  // namespace psi_slam
