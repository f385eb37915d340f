// SPDX-License-Identifier: BSD-3-Clause
// Measures the longest times in which the window does not react while it shows a benchmark log. Prints and
// records these times but does not check them, because machines differ too much.
#include <gmock/gmock.h>

#include <cstdlib>

#include "gui_run.h"
#include "loop_inspector.h"
#include "shared_logs.h"

namespace psi_slam {
namespace {

TEST(Gaps, between_events_of_a_benchmark_log) {
  if (std::getenv("PSI_SLAM_LONG_TESTS") == nullptr) GTEST_SKIP() << "takes minutes: set PSI_SLAM_LONG_TESTS";
  if (!GuiRun::has_display()) GTEST_SKIP() << "needs xvfb-run from Debian's package xvfb";
  const auto log = shared_file("fr079.clf.gz");
  if (!log) GTEST_SKIP() << kNeedsData;
  GuiRun gui;
  gui.patience(std::chrono::minutes(4))
      .gauge("idle")
      .pause(2000)
      .gauge("opening")
      .then([&](MainFrame& frame) { frame.open_log(*log); });
  gui.when_phase(ReplayPhase::kPaused)
      .pause(500)
      .gauge("playing")
      .command(kPlayOrPause)
      .when_phase(ReplayPhase::kFinalSearch)
      .gauge("final_search")
      .when_phase(ReplayPhase::kFinished)
      .pause(1500)
      .gauge("selecting");
  for (const std::size_t row : {3U, 100U, 700U, 1500U})
    gui.then([row](MainFrame& frame) {
         const LoopTable& table = frame.loops().table();
         ASSERT_GT(table.rows(), row);
         frame.loops().select(table.loop_of(row));
       })
        .pause(300);
  gui.gauge("resizing");
  for (const int width : {1200, 1500, 1000, 1400})
    gui.then([width](MainFrame& frame) { frame.SetSize(width, 900); }).pause(300);
  gui.gauge("layers");
  for (const MapLayer layer : {MapLayer::kConstraints, MapLayer::kNodes, MapLayer::kLoops})
    gui.command(kLayer + static_cast<int>(layer)).pause(300);
  gui.gauge("exporting")
      .then([&](MainFrame& frame) { frame.export_to(gui.folder() / "out", false); })
      .when("the export is complete",
            [](MainFrame& frame) { return frame.replay()->snapshot()->exported.has_value(); })
      .gauge("idle_with_map")
      .pause(2000);
  EXPECT_EQ(gui.run({}), 0);
  EXPECT_TRUE(std::filesystem::exists(gui.folder() / "out" / "report.html"));
}

}  // namespace
}  // namespace psi_slam
