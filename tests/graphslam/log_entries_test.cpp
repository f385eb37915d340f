// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/graphslam/log_entries.h"

#include <gtest/gtest.h>

#include "psi_slam/logs/entry_frames.h"
#include "simulated_rawlog.h"
#include "temporary_folder.h"

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

INSTANTIATE_TEST_SUITE_P(Forms, LogEntriesOfEitherForm, ::testing::Values(1, 2));

}  // namespace
}  // namespace psi_slam
