// SPDX-License-Identifier: BSD-3-Clause
// Tests the comparison of results that the tests of whole runs use.
#include "same_results.h"

#include <gmock/gmock.h>

#include "map/report/output_folder.h"
#include "psi_slam/mapping_session.h"
#include "room_log.h"
#include "session/settings.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
namespace fs = std::filesystem;

class SameResults : public testing::Test {
 protected:
  void SetUp() override {
    const auto log = write_lines(folder_.path() / "room.log", room_log_lines(40));
    for (const fs::path& results : {a_, b_}) {
      MappingSession session(log, Settings{});
      session.run(std::atomic<bool>(false));
      session.export_to(OutputFolder::prepare(results, false));
    }
  }

  TemporaryFolder folder_;
  const fs::path a_ = folder_.path() / "a";
  const fs::path b_ = folder_.path() / "b";
};

TEST_F(SameResults, are_those_of_two_runs_though_their_times_differ) {
  EXPECT_THAT(differing_files(a_, b_), IsEmpty());
}

TEST_F(SameResults, are_not_those_with_one_file_missing_or_changed) {
  for (const std::string& name : names_of_files(a_)) {
    const std::string bytes = read_file(b_ / name);
    fs::remove(b_ / name);
    EXPECT_THAT(differing_files(a_, b_), ElementsAre(name));
    std::string changed = bytes;
    const std::string first_row_or_scans = name == "summary.json" ? "\"scans\": 4" : "\n";
    const std::size_t at = name == "report.html" ? bytes.find("<h2>Map") + 4 : bytes.find(first_row_or_scans);
    changed.insert(at == std::string::npos ? 0 : at + first_row_or_scans.size(), "1");
    write_file(b_ / name, changed);
    EXPECT_THAT(differing_files(a_, b_), ElementsAre(name));
    write_file(b_ / name, bytes);
  }
}

}  // namespace
}  // namespace psi_slam
