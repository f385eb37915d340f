// SPDX-License-Identifier: BSD-3-Clause
// Maps the logs of the Freiburg benchmark with their settings files, and limits errors and memory.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <ostream>

#include "app_run.h"
#include "map/trajectory/relations_metric.h"
#include "map/trajectory/trajectory_file.h"
#include "sanitizer.h"
#include "shared_logs.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

struct Benchmark {
  const char* log;
  double max_error_m;  ///< largest accepted mean translational error over all relations
  int every_nth_scan = 1;
  double max_gap_s = 2;  ///< longest gap in the path over which a pose is interpolated

  friend std::ostream& operator<<(std::ostream& out, const Benchmark& benchmark) {
    return out << benchmark.log << ", every " << benchmark.every_nth_scan;
  }
};

std::string name_of(const testing::TestParamInfo<Benchmark>& info) {
  std::string name = info.param.log;
  for (char& c : name) c = c == '-' ? '_' : c;
  const int nth = info.param.every_nth_scan;
  return nth == 1 ? name : name + "_every_" + std::to_string(nth) + "th_scan";
}

/// Warnings about a log that is mapped as it is, as a regular expression.
std::string warnings_about(const std::string& log) {
  // Scans are missing for three seconds in which the robot turns, and odometry contradicts the scans.
  if (log == "aces")
    return "psi-slam: the place of the robot was lost between 8:59 and 9:02, and found again at "
           "9:(0[7-9]|1[0-4])\n";
  if (log == "intel") return "";
  return "psi-slam: turns show that the scans are stamped 0\\.[1-7][0-9]* s later than odometry [^\n]*\n";
}

class BenchmarkLog : public testing::TestWithParam<Benchmark> {};

TEST_P(BenchmarkLog, is_mapped_within_its_limits) {
  const Benchmark& benchmark = GetParam();
  const std::string name = benchmark.log;
  const auto log = shared_file(name + ".clf.gz");
  const auto relations = shared_file(name + ".relations");
  if (!log || !relations) GTEST_SKIP() << kNeedsData;
  const TemporaryFolder folder;
  const std::filesystem::path output = folder.path() / "out";
  const AppProcess process({"-c", std::string(PSI_SLAM_INI_FOLDER) + '/' + name + ".ini", "-q", "--set",
                            "log.every_nth_scan=" + std::to_string(benchmark.every_nth_scan), log->string(),
                            "-o", output.string()},
                           folder.path());
  const AppRun run = process.finish();
  ASSERT_EQ(run.code, 0);
  EXPECT_THAT(run.out + run.err, testing::MatchesRegex(warnings_about(name))) << "quiet but for warnings";
  const RelationsMetric metric = evaluate_relations(read_trajectory(output / "trajectory.tum"),
                                                    read_relations(*relations), benchmark.max_gap_s);
  RecordProperty("mean_relation_error_m", std::to_string(metric.translation_abs_m.mean));
  EXPECT_EQ(metric.skipped, 0U);
  EXPECT_LE(metric.translation_abs_m.mean, benchmark.max_error_m);
  const auto summary = nlohmann::json::parse(bytes_of(output / "summary.json"));
  EXPECT_LT(summary["peak_memory_mib"], kHasAddressSanitizer ? 2048 : 1024);
}

INSTANTIATE_TEST_SUITE_P(EachIni, BenchmarkLog,
                         testing::Values(Benchmark{"intel", 0.030}, Benchmark{"mit-csail", 0.050},
                                         Benchmark{"aces", 0.060}, Benchmark{"fr079", 0.060},
                                         Benchmark{"mit-killian", 0.120}),
                         name_of);

INSTANTIATE_TEST_SUITE_P(FewScans, BenchmarkLog,
                         testing::Values(Benchmark{"intel", 0.1, 5, 5}, Benchmark{"intel", 0.3, 15, 5}),
                         name_of);

}  // namespace
}  // namespace psi_slam
