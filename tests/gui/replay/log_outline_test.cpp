// SPDX-License-Identifier: BSD-3-Clause
#include "gui/log_outline.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "../../session/room_log.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

std::vector<TimeUs> stamps_of(const std::filesystem::path& log) {
  const LogOutline outline(SessionInput(log), {});
  while (outline.stamps_us() == nullptr) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return *outline.stamps_us();
}

TEST(LogOutline, reads_the_time_stamps_of_all_scans) {
  const TemporaryFolder folder;
  const auto stamps = stamps_of(write_lines(folder.path() / "room.log", room_log_lines(10)));
  ASSERT_EQ(stamps.size(), 10U);
  for (std::size_t i = 1; i < stamps.size(); ++i) EXPECT_EQ(stamps[i] - stamps[i - 1], 200'000);
}

TEST(LogOutline, reads_a_truncated_log_up_to_its_last_whole_line) {
  const TemporaryFolder folder;
  auto lines = room_log_lines(10);
  lines.push_back("FLASER 181 1.0");
  EXPECT_EQ(stamps_of(write_lines(folder.path() / "room.log", lines)).size(), 10U);
}

TEST(LogOutline, is_empty_for_an_unreadable_log) {
  EXPECT_TRUE(stamps_of("/missing/room.log").empty());
}

TEST(LogOutline, stops_in_the_middle_when_destroyed) {
  const TemporaryFolder folder;
  const auto log = write_lines(folder.path() / "room.log", room_log_lines(2000));
  const LogOutline outline(SessionInput(log), {});
}

}  // namespace
}  // namespace psi_slam
