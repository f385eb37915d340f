// SPDX-License-Identifier: BSD-3-Clause
#include "plot_panel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../session/room_log.h"
#include "gui_run.h"
#include "map/report/decade_axis.h"

namespace psi_slam {
namespace {

HistoryView<FrameRecord> frames(std::size_t count) {
  SharedHistory<FrameRecord> history;
  for (std::size_t i = 0; i < count; ++i) {
    FrameRecord frame;
    frame.psi = static_cast<double>(i);
    frame.response = i % 2 == 0 ? 0.8 : 0.4;
    frame.match = i == 25 ? ScanMatch::kUnmatched : ScanMatch::kMatched;
    frame.loops_tried = 2;
    frame.loops_accepted = 1;
    frame.front_end_ms = 3;
    if (i == 4) frame.matcher = MatcherKind::kGa;
    history.push_back(frame);
  }
  return history.view();
}

TEST(PlotColumns, has_one_column_for_each_scan_if_there_is_room) {
  const std::vector<PlotColumn> columns = plot_columns(frames(10), 100);
  ASSERT_EQ(columns.size(), 10U);
  EXPECT_EQ(columns[3].first_frame, 3U);
  EXPECT_EQ(columns[3].psi, 3);
  EXPECT_EQ(columns[3].matcher, std::nullopt);
  EXPECT_EQ(columns[9].matcher, MatcherKind::kGa) << "the matcher of the last node";
  EXPECT_EQ(columns[9].loops_accepted, 10);
}

TEST(PlotColumns, combines_scans_if_there_is_no_room) {
  const std::vector<PlotColumn> columns = plot_columns(frames(1000), 100);
  ASSERT_EQ(columns.size(), 100U);
  EXPECT_EQ(columns[1].first_frame, 10U);
  EXPECT_EQ(columns[1].psi, 19) << "the largest value";
  EXPECT_EQ(columns[1].response_min, 0.4);
  EXPECT_EQ(columns[1].response_max, 0.8);
  EXPECT_EQ(columns[1].front_end_ms, 3) << "the mean";
  EXPECT_FALSE(columns[1].unmatched);
  EXPECT_TRUE(columns[2].unmatched) << "one of its scans";
  EXPECT_EQ(columns[99].loops_tried, 2000);
}

TEST(PlotColumns, is_empty_without_scans) {
  EXPECT_TRUE(plot_columns({}, 100).empty());
}

/// The row of the picture with the most pixels of the colour of thresholds.
int row_of_threshold(const wxImage& picture) {
  int best_row = -1;
  int most = 0;
  for (int y = 0; y < picture.GetHeight(); ++y) {
    int count = 0;
    for (int x = 0; x < picture.GetWidth(); ++x)
      count += picture.GetRed(x, y) > 180 && picture.GetGreen(x, y) < 120 && picture.GetBlue(x, y) < 120;
    if (count <= most) continue;
    most = count;
    best_row = y;
  }
  return best_row;
}

TEST(PlotPanel, draws_psi_on_the_logarithmic_axis_of_the_report) {
  if (!GuiRun::has_display()) GTEST_SKIP() << "needs xvfb-run from Debian's package xvfb";
  GuiRun gui;
  const std::string log = write_lines(gui.folder() / "room.log", room_log_lines()).string();
  gui.when_phase(ReplayPhase::kPaused)
      .command(kPlayOrPause)
      .when_phase(ReplayPhase::kFinished)
      .screenshot("plots")
      .then([](MainFrame& frame) {
        const ReplaySnapshot& run = *frame.replay()->snapshot();
        double most = 0;
        for (std::size_t i = 0; i < run.frames.size(); ++i) most = std::max(most, run.frames[i].psi);
        ASSERT_EQ(run.psi.psi_1, run.psi.psi_2) << "there is one line to look for";
        const wxWindow* const plots = wxWindow::FindWindowByName("plots", &frame);
        const wxRect panel = plots->GetScreenRect();
        const double strip = panel.height / 4;
        const wxImage picture =
            screen_image(panel.GetPosition(), wxSize(panel.width, static_cast<int>(strip)));
        const double top = plots->FromDIP(20);
        const double height = strip - top - plots->FromDIP(6);
        const double share = psi_axis(most, run.psi).share(run.psi.psi_1);
        EXPECT_NEAR(row_of_threshold(picture), top + height * (1 - share), 2);
      });
  EXPECT_EQ(gui.run({log}), 0);
}

TEST(RoundUp, returns_the_next_1_2_or_5_times_a_power_of_ten) {
  EXPECT_EQ(round_up(0.03), 0.05);
  EXPECT_EQ(round_up(1), 1);
  EXPECT_EQ(round_up(1.2), 2);
  EXPECT_EQ(round_up(7), 10);
  EXPECT_EQ(round_up(0), 1);
}

}  // namespace
}  // namespace psi_slam
