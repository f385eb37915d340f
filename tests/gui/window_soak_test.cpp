// SPDX-License-Identifier: BSD-3-Clause
// Opens and replays a log again and again in one window.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <iostream>
#include <string>
#include <vector>

#include "../session/room_log.h"
#include "allocated_memory.h"
#include "gui_run.h"

namespace psi_slam {
namespace {

/// Returns the number of cycles: that of the variable PSI_SLAM_SOAK_CYCLES, or a few.
std::size_t cycles() {
  constexpr std::size_t kFew = 8;
  const char* const text = std::getenv("PSI_SLAM_SOAK_CYCLES");
  return text == nullptr ? kFew : std::max<std::size_t>(2, std::stoul(text));
}

TEST(WindowSoakTest, opening_and_replaying_a_log_again_and_again_keeps_the_memory) {
  if (!GuiRun::has_display()) GTEST_SKIP() << "needs xvfb-run from Debian's package xvfb";
  if (kHasAddressSanitizer || kHasThreadSanitizer)
    GTEST_SKIP() << "sanitizers have their own memory allocation";
  GuiRun gui;
  const std::string log = write_lines(gui.folder() / "room.log", room_log_lines(60)).string();
  std::vector<double> memory_MiB;
  for (std::size_t cycle = 0; cycle < cycles(); ++cycle) {
    if (cycle > 0) gui.then([&](MainFrame& frame) { frame.open_log(log); });
    gui.when_phase(ReplayPhase::kPaused)
        .command(kPlayOrPause)
        .when_phase(ReplayPhase::kFinished)
        .when("the map is drawn",
              [](MainFrame& frame) {
                return frame.replay()->drawn_map() && frame.replay()->drawn_map()->scans == 60;
              })
        .then([&](MainFrame&) { memory_MiB.push_back(allocated_MiB()); });
  }
  EXPECT_EQ(gui.run({log}), 0);
  ASSERT_EQ(memory_MiB.size(), cycles());
  // Caches fill in the first cycles.
  const std::size_t settled = std::min<std::size_t>(memory_MiB.size() / 2, 20);
  const auto later = static_cast<double>(memory_MiB.size() - 1 - settled);
  std::cout << "memory after cycle " << settled << ": " << memory_MiB[settled] << " MiB, after cycle "
            << memory_MiB.size() - 1 << ": " << memory_MiB.back() << " MiB\n";
  constexpr double kCacheGrowth_MiB = 0.8;
  constexpr double kGrowthPerCycle_MiB = 0.002;  // a scan of the log takes 3 kB
  EXPECT_LT(memory_MiB.back(), memory_MiB[settled] + kCacheGrowth_MiB + kGrowthPerCycle_MiB * later);
}

}  // namespace
}  // namespace psi_slam
