// SPDX-License-Identifier: BSD-3-Clause
#include "live/live_source.h"

#include <gmock/gmock.h>

#include "base/compression/line_reader.h"
#include "psi_slam/open_log.h"
#include "same_frames.h"
#include "shared_logs.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;

LiveControl quiet_control() {
  return {[] { return false; }, [](const std::string&) {}};
}

/// Follows a file until its end.
LiveInput to_the_end_of(const std::filesystem::path& file) {
  LiveInput input;
  input.kind = LiveInput::Kind::kFollow;
  input.file = file.string();
  input.idle_s = 0;
  return input;
}

/// A real log, and the number of its lines that are read.
class RealLog : public testing::TestWithParam<const char*> {};

TEST_P(RealLog, gives_the_same_frames_while_it_grows) {
  const auto log = shared_file(GetParam());
  if (!log) GTEST_SKIP() << kNeedsData;
  const TemporaryFolder folder;
  const auto file = folder.path() / "begin.log";
  std::string text;
  LineReader lines(*log);
  std::string_view line;
  for (int i = 0; i < 1500 && lines.next(line); ++i) text.append(line) += '\n';
  write_file(file, text);
  LogOptions options;
  options.max_range_m = 50;  // the code for no return may be unknown in the first seconds of a stream
  const auto live = open_live(to_the_end_of(file), options, quiet_control());
  const auto whole = open_log(file, options);
  EXPECT_GT(expect_same_frames(*live, *whole), 100U);
  EXPECT_EQ(live->assumptions(), whole->assumptions());
  EXPECT_EQ(live->skipped_lines().count, whole->skipped_lines().count);
}

class RealBag : public testing::TestWithParam<const char*> {};

TEST_P(RealBag, gives_the_same_frames_while_it_grows) {
  const auto bag = shared_file(GetParam());
  if (!bag) GTEST_SKIP() << kNeedsData;
  const auto live = open_live(to_the_end_of(*bag), {}, quiet_control());
  const auto whole = open_log(*bag);
  EXPECT_GT(expect_same_frames(*live, *whole), 100U);
  EXPECT_EQ(live->skipped_lines().count, whole->skipped_lines().count);
}

INSTANTIATE_TEST_SUITE_P(LiveSource, RealBag,
                         testing::Values("bags/guardian_controller_2.bag",
                                         "bags/jarvis_circular_path_fast.bag", "bags/jan17_expt04.bag"),
                         [](const auto& bag) { return "bag_" + std::to_string(bag.index); });

INSTANTIATE_TEST_SUITE_P(LiveSource, RealLog,
                         testing::Values("aces.clf.gz", "intel.clf.gz", "mit-csail.clf.gz",
                                         "mit-killian.clf.gz", "fr079.clf.gz", "sparse/acapulco.clf.gz",
                                         "sparse/fhw.clf.gz", "sparse/freiburg-campus.clf.gz"),
                         [](const auto& log) { return "log_" + std::to_string(log.index); });

TEST(LiveSource, refuses_options_that_need_a_complete_log) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "my.log";
  write_file(file, "");
  LogOptions calibrated;
  calibrated.calibrate = true;
  EXPECT_THAT(sentence_of([&] { open_live(to_the_end_of(file), calibrated, quiet_control()); }),
              HasSubstr("log.calibrate needs a complete log"));
  LogOptions topic;
  topic.odometry = "/odom";
  EXPECT_THAT(sentence_of([&] { open_live(to_the_end_of(file), topic, quiet_control()); }),
              HasSubstr("log.odometry is \"/odom\", expected auto or none"));
}

TEST(LiveSource, a_source_without_scans_is_an_error_of_its_first_frame) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "my.log";
  write_file(file, "");
  const auto live = open_live(to_the_end_of(file), {}, quiet_control());
  EXPECT_THAT(live->assumptions(), testing::IsEmpty());
  EXPECT_THAT(sentence_of([&] { live->next(); }), HasSubstr("my.log has no laser scans"));
  EXPECT_FALSE(live->next());
}

}  // namespace
}  // namespace psi_slam
