// SPDX-License-Identifier: BSD-3-Clause
#include "live_mapping.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "../session/room_log.h"
#include "psi_slam/mapping_session.h"
#include "session/settings.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

class LiveMappingTest : public testing::Test {
 protected:
  LiveMappingTest() { settings_.live.map_period_s = 1e-3; }

  bool map_appears() const {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!std::filesystem::exists(folder_.path() / "map.yaml")) {
      if (std::chrono::steady_clock::now() > end) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
  }

  TemporaryFolder folder_;
  Settings settings_;
  MappingSession session_{write_lines(folder_.path() / "room.log", room_log_lines(300)), settings_};
};

TEST_F(LiveMappingTest, writes_the_map_though_scans_always_wait) {
  LiveMapping mapping(session_, folder_.path(), settings_, [](const std::string&) {});
  for (int scan = 0; scan < 100; ++scan) {
    while (scan < 99 && !session_.scan_waits()) std::this_thread::yield();
    ASSERT_TRUE(mapping.step());
  }
  EXPECT_TRUE(map_appears());
}

TEST_F(LiveMappingTest, ends_after_the_last_scan) {
  LiveMapping mapping(session_, folder_.path(), settings_, [](const std::string&) {});
  int scans = 0;
  while (mapping.step()) ++scans;
  EXPECT_EQ(scans, 300);
  mapping.catch_up();
  EXPECT_TRUE(map_appears());
}

}  // namespace
}  // namespace psi_slam
