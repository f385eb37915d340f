// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt/log_entries.h"

#include <gmock/gmock.h>

#include "mrpt/entry_frames.h"
#include "simulated_rawlog.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

std::vector<Frame> short_drive() {
  const std::vector<Frame>& frames = simulated_drive().frames;
  return {frames.begin(), frames.begin() + 40};
}

std::vector<Frame> frames_of(const std::filesystem::path& rawlog) {
  EntryFrames entries{LogOptions()};
  const auto log = open_log_entries(rawlog, {});
  std::vector<Frame> frames;
  while (const std::optional<LogEntry> entry = log->next()) {
    entries.take(entry->action, entry->observations, entry->observation);
    while (std::optional<Frame> frame = entries.next()) frames.push_back(*std::move(frame));
  }
  entries.end_of_log();
  while (std::optional<Frame> frame = entries.next()) frames.push_back(*std::move(frame));
  return frames;
}

class LogEntriesOfEitherForm : public ::testing::TestWithParam<int> {};

TEST_P(LogEntriesOfEitherForm, give_the_frames_that_were_written) {
  const TemporaryFolder folder;
  const std::vector<Frame> written = short_drive();
  const std::vector<Frame> frames =
      frames_of(write_rawlog(folder.path() / "drive.rawlog", written, GetParam()));
  ASSERT_EQ(frames.size(), written.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].index, i);
    EXPECT_EQ(frames[i].time_us, written[i].time_us);
    const auto moved = frames[i].odom_T_robot - frames.front().odom_T_robot;
    const auto truly = written[i].odom_T_robot - written.front().odom_T_robot;
    EXPECT_NEAR(moved.x, truly.x, 1e-6);
    EXPECT_NEAR(moved.phi, truly.phi, 1e-6);
    EXPECT_GE(frames[i].scan.ranges_m.size(), written[i].scan.ranges_m.size());
  }
}

/// Returns the labels of the scans in each entry that has scans.
std::vector<std::vector<std::string>> labels_of(LogEntries& log) {
  std::vector<std::vector<std::string>> all;
  while (const std::optional<LogEntry> entry = log.next()) {
    std::vector<std::string> labels;
    const auto add = [&](const mrpt::obs::CObservation::Ptr& observation) {
      if (std::dynamic_pointer_cast<mrpt::obs::CObservation2DRangeScan>(observation))
        labels.push_back(observation->sensorLabel);
    };
    if (entry->observation) add(entry->observation);
    if (entry->observations)
      for (const auto& observation : *entry->observations) add(observation);
    if (!labels.empty()) all.push_back(labels);
  }
  return all;
}

std::vector<std::vector<std::string>> labels_of_two_lasers(int form, const std::string& laser) {
  const TemporaryFolder folder;
  const auto rawlog = write_rawlog_of_lasers(folder.path() / "two.rawlog", short_drive(), form, true, true);
  LogOptions options;
  options.laser = laser;
  return labels_of(*open_log_entries(rawlog, options));
}

TEST_P(LogEntriesOfEitherForm, have_the_scans_of_one_of_two_lasers) {
  using Labels = std::vector<std::vector<std::string>>;
  EXPECT_EQ(labels_of_two_lasers(GetParam(), ""), Labels(short_drive().size(), {"right"}));
  EXPECT_EQ(labels_of_two_lasers(GetParam(), "left"), Labels(short_drive().size(), {"left"}));
}

TEST_P(LogEntriesOfEitherForm, have_all_lasers_that_are_asked_for_in_one_frame_the_first_one_first) {
  for (const char* lasers : {"all", "left, right"}) {
    const auto labels = labels_of_two_lasers(GetParam(), lasers);
    EXPECT_EQ(labels.size(), short_drive().size());
    for (const auto& of_entry : labels) EXPECT_THAT(of_entry, ::testing::ElementsAre("LASER", "LASER2"));
  }
}

TEST_P(LogEntriesOfEitherForm, name_the_lasers_when_none_has_the_name_asked_for) {
  EXPECT_THAT(
      sentence_of([&] { labels_of_two_lasers(GetParam(), "rear"); }),
      ::testing::AllOf(::testing::HasSubstr("log.laser is \"rear\", expected the label of a laser of "),
                       ::testing::HasSubstr("\"left\", \"right\"")));
}

INSTANTIATE_TEST_SUITE_P(Forms, LogEntriesOfEitherForm, ::testing::Values(1, 2));

}  // namespace
}  // namespace psi_slam
