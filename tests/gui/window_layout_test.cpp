// SPDX-License-Identifier: BSD-3-Clause
#include "window_layout.h"

#include <gmock/gmock.h>
#include <wx/display.h>

#include "gui_run.h"
#include "map_canvas.h"
#include "test_files.h"

namespace psi_slam {
namespace {

bool shown(MainFrame& frame, const char* pane) {
  const wxAuiPaneInfo& info = frame.panes().GetPane(pane);
  return info.IsOk() && info.IsShown();
}

class WindowLayoutTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!GuiRun::has_display()) GTEST_SKIP() << "needs xvfb-run from Debian's package xvfb";
  }
  /// Writes the configuration file that an earlier start of the program would have left.
  void write_choices(const std::string& lines) {
    std::filesystem::create_directories(gui_.folder() / "config");
    write_file(gui_.folder() / "config" / "psi-slam-gui.conf", lines);
  }
  static void expect_whole(MainFrame& frame) {
    for (const char* pane : {"map", "settings", "loops", "plots"}) EXPECT_TRUE(shown(frame, pane)) << pane;
    const wxRect screen = wxDisplay(0U).GetClientArea();
    EXPECT_TRUE(screen.Contains(frame.GetRect())) << frame.GetRect().x << ' ' << frame.GetRect().y;
  }

  GuiRun gui_;
};

TEST_F(WindowLayoutTest, is_kept_for_the_next_window) {
  MainFrame* window = nullptr;
  const int nodes = kLayer + static_cast<int>(MapLayer::kNodes);
  gui_.then([&](MainFrame&) {
        window = new MainFrame();
        window->Show();
        window->SetSize(window->FromDIP(wxSize(1111, 777)));
      })
      .pause(300)
      .then([&](MainFrame&) {
        GuiRun::choose(*window, kPanePlots);
        GuiRun::choose(*window, nodes);
        GuiRun::choose(*window, kRejectedLoops);
        GuiRun::choose(*window, kLoopsByResidual);
        window->Close(true);
      })
      .pause(300)
      .then([&](MainFrame&) {
        window = new MainFrame();
        window->Show();
      })
      .pause(300)
      .then([&](MainFrame&) {
        EXPECT_EQ(window->GetSize(), window->FromDIP(wxSize(1111, 777)));
        EXPECT_FALSE(shown(*window, "plots"));
        EXPECT_TRUE(shown(*window, "loops"));
        EXPECT_FALSE(window->GetMenuBar()->IsChecked(kPanePlots));
        EXPECT_TRUE(window->GetMenuBar()->IsChecked(nodes));
        EXPECT_TRUE(window->map().map_scene().visible(MapLayer::kNodes));
        EXPECT_TRUE(window->map().map_scene().loop_style().rejected);
        EXPECT_TRUE(window->GetMenuBar()->IsChecked(kLoopsByResidual));
        GuiRun::choose(*window, kDefaultLayout);
        EXPECT_TRUE(shown(*window, "plots"));
        EXPECT_TRUE(window->GetMenuBar()->IsChecked(kPanePlots));
        window->Close(true);
      });
  EXPECT_EQ(gui_.run({}), 0);
}

TEST_F(WindowLayoutTest, keeps_the_layer_of_loops_without_closing_the_window) {
  const int loops = kLayer + static_cast<int>(MapLayer::kLoops);
  const auto saved = [&] { return read_file(gui_.folder() / "config" / "psi-slam-gui.conf"); };
  MainFrame* next = nullptr;
  gui_.command(loops)
      .then([&](MainFrame&) { EXPECT_THAT(saved(), testing::HasSubstr("Loops=0")); })
      .command(kLoopsByResidual)
      .then([&](MainFrame&) {
        EXPECT_THAT(saved(), testing::HasSubstr("residual=1"));
        next = new MainFrame();
        EXPECT_FALSE(next->map().map_scene().visible(MapLayer::kLoops));
        EXPECT_TRUE(next->map().map_scene().visible(MapLayer::kTrajectory));
        EXPECT_FALSE(next->GetMenuBar()->IsChecked(loops));
        EXPECT_TRUE(next->GetMenuBar()->IsChecked(kLoopsByResidual));
        next->Close(true);
      })
      .command(loops)
      .then([&](MainFrame&) { EXPECT_THAT(saved(), testing::HasSubstr("Loops=1")); });
  EXPECT_EQ(gui_.run({}), 0);
}

TEST_F(WindowLayoutTest, of_another_screen_keeps_the_window_visible) {
  write_choices(
      "[window]\nversion=1\nx=99999\ny=-5000\nwidth=20000\nheight=9000\n"
      "panes=layout2|name=map;state=768|dock_size(5,0,0)=1|\n");
  gui_.pause(300).then([](MainFrame& frame) { expect_whole(frame); }).screenshot("restored");
  EXPECT_EQ(gui_.run({}), 0);
}

TEST_F(WindowLayoutTest, of_another_version_is_ignored) {
  write_choices("[window]\nversion=77\nx=50\ny=50\nwidth=800\nheight=600\npanes=nonsense\n");
  gui_.pause(300).then([](MainFrame& frame) {
    expect_whole(frame);
    EXPECT_GT(frame.GetSize().x, frame.FromDIP(800));
  });
  EXPECT_EQ(gui_.run({}), 0);
}

}  // namespace
}  // namespace psi_slam
