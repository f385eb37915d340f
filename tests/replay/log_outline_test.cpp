// SPDX-License-Identifier: BSD-3-Clause
#include "replay/log_outline.h"

#include <gtest/gtest.h>

#include <chrono>

#include "../session/room_log.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

std::vector<TimeUs> stamps_of(const std::filesystem::path& log) {
  const LogOutline outline(SessionInput(log), {});
  while (outline.stamps_us() == nullptr) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return *outline.stamps_us();
}

TEST(LogOutline, knows_when_each_scan_was_taken) {
  const TemporaryFolder folder;
  const auto stamps = stamps_of(write_lines(folder.path() / "room.log", room_log_lines(10)));
  ASSERT_EQ(stamps.size(), 10U);
  for (std::size_t i = 1; i < stamps.size(); ++i) EXPECT_EQ(stamps[i] - stamps[i - 1], 200'000);
}

TEST(LogOutline, of_a_log_that_breaks_off_it_knows_what_can_be_read) {
  const TemporaryFolder folder;
  auto lines = room_log_lines(10);
  lines.push_back("FLASER 181 1.0");
  EXPECT_EQ(stamps_of(write_lines(folder.path() / "room.log", lines)).size(), 10U);
}

TEST(LogOutline, of_a_log_that_cannot_be_read_there_is_nothing) {
  EXPECT_TRUE(stamps_of("/missing/room.log").empty());
}

TEST(LogOutline, is_left_in_the_middle) {
  const TemporaryFolder folder;
  const auto log = write_lines(folder.path() / "room.log", room_log_lines(2000));
  const LogOutline outline(SessionInput(log), {});
}

}  // namespace
}  // namespace psi_slam
