// SPDX-License-Identifier: BSD-3-Clause
// Recordings with one fault each, whose maps are compared with the true path.
#include <gmock/gmock.h>

#include "app_run.h"
#include "path_error.h"
#include "shared_logs.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

struct FaultyLog {
  std::string file;   // in the folder faults
  std::string truth;  // file beside it
  double max_error_m = 0;
  std::string sentence;                  // part of what psi-slam prints; empty: prints nothing
  std::vector<std::string> arguments{};  // besides the log and the output folder
  friend void PrintTo(const FaultyLog& log, std::ostream* out) { *out << log.file; }
};

class RecordedFault : public testing::TestWithParam<FaultyLog> {};

TEST_P(RecordedFault, does_not_spoil_the_map) {
  const auto log = shared_file("faults/" + GetParam().file);
  if (!log) GTEST_SKIP() << kNeedsData;
  const TemporaryFolder folder;
  const fs::path out = folder.path() / "map";
  std::vector<std::string> arguments{log->string(), "-o", out.string(), "-q"};
  arguments.insert(arguments.end(), GetParam().arguments.begin(), GetParam().arguments.end());
  const AppRun run = run_app(arguments);
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_LE(path_error_m(out / "trajectory.tum", log->parent_path() / GetParam().truth),
            GetParam().max_error_m);
  if (GetParam().sentence.empty()) {
    EXPECT_EQ(run.err, "");
  } else {
    EXPECT_THAT(run.err, HasSubstr(GetParam().sentence));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, RecordedFault,
    testing::Values(
        FaultyLog{"one_bad_scan.db3.zstd", "small.tum", 0.02, "1 message of the log is unusable"},
        FaultyLog{"two_robots.db3.zstd", "robot2.tum", 0.016, "", {"--set", "log.scan_topic=/robot2/scan"}},
        FaultyLog{"stall_a.clf.gz", "stall.tum", 0.01, "18 scans repeat the readings of an earlier scan"},
        FaultyLog{"stall_none.clf.gz", "stall.tum", 0.01, ""},
        FaultyLog{"published_twice.db3.zstd", "small.tum", 0.01,
                  "scans repeat the readings of an earlier scan"},
        FaultyLog{"first_scan_bad.db3.zstd", "small.tum", 0.02, "1 message of the log is unusable"}),
    [](const auto& tested) { return tested.param.file.substr(0, tested.param.file.find('.')); });

TEST(RecordedFaults, a_log_packed_by_bzip2_gives_the_map_of_the_log_packed_by_gzip) {
  const auto bzip2 = shared_file("faults/plain.log.bz2");
  const auto gzip = shared_file("faults/right_fov.log.gz");
  if (!bzip2 || !gzip) GTEST_SKIP() << kNeedsData;
  const TemporaryFolder folder;
  ASSERT_EQ(run_app({bzip2->string(), "-o", (folder.path() / "a").string(), "-q"}).code, 0);
  ASSERT_EQ(run_app({gzip->string(), "-o", (folder.path() / "b").string(), "-q"}).code, 0);
  for (const char* name : {"trajectory.tum", "map.png"})
    EXPECT_TRUE(bytes_of(folder.path() / "a" / name) == bytes_of(folder.path() / "b" / name)) << name;
}

}  // namespace
}  // namespace psi_slam
