// SPDX-License-Identifier: BSD-3-Clause
#include "simulate/simulated_log_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <string>
#include <vector>

#include "psi_slam/user_error.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

/// Limits the size of files of this process, as if the disk were full.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit small{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &small);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  ~SmallDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int) = std::signal(SIGXFSZ, SIG_IGN);
};

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

TEST(SimulatedLogFile, writes_only_the_log_and_its_truth) {
  const TemporaryFolder folder;
  write_simulated_log(folder.path() / "run.clf.gz", simulated_log_options(20, 1));
  EXPECT_EQ(names_in(folder.path()), (std::vector<std::string>{"run.clf.gz", "run.relations", "run.tum"}));
}

TEST(SimulatedLogFile, leaves_nothing_when_the_disk_is_full) {
  const TemporaryFolder folder;
  const SimulatedLogOptions run = simulated_log_options(20, 1);
  write_simulated_log(folder.path() / "run.clf.gz", run);
  const std::uintmax_t compressed = fs::file_size(folder.path() / "run.clf.gz");
  const fs::path full = folder.path() / "full";
  fs::create_directory(full);
  const SmallDisk disk(compressed / 2);  // the uncompressed log is even larger
  EXPECT_THROW(write_simulated_log(full / "run.clf.gz", run), SystemFailure);
  EXPECT_TRUE(fs::is_empty(full)) << names_in(full).front();
}

TEST(SimulatedLogFile, leaves_nothing_when_the_name_belongs_to_a_folder) {
  const TemporaryFolder folder;
  const fs::path no_file = folder.path() / "run.clf.gz";
  fs::create_directories(no_file / "in the way");
  EXPECT_THROW(write_simulated_log(no_file, simulated_log_options(20, 1)), SystemFailure);
  EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"run.clf.gz"});
}

}  // namespace
}  // namespace psi_slam
