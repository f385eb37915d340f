// SPDX-License-Identifier: BSD-3-Clause
// Tests on a screen of 1500 x 950 pixels with a window manager, which main() starts for tests of this name.
#include <gtest/gtest.h>
#include <wx/display.h>
#include <wx/statusbr.h>

#include "gui_run.h"
#include "window_manager.h"

namespace psi_slam {
namespace {

class SmallScreenTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!GuiRun::has_display()) GTEST_SKIP() << "needs xvfb-run from Debian's package xvfb";
    if (!has_window_manager()) GTEST_SKIP() << "needs Debian's package openbox";
    ASSERT_TRUE(wait_for_window_manager());
  }
  /// Number of dark pixels in a part of the screen.
  static int dark_pixels(const wxRect& area) {
    const wxImage image = screen_image(area.GetPosition(), area.GetSize());
    int count = 0;
    for (int y = 0; y < image.GetHeight(); ++y)
      for (int x = 0; x < image.GetWidth(); ++x)
        count += image.GetRed(x, y) < 110 && image.GetGreen(x, y) < 110 && image.GetBlue(x, y) < 110 ? 1 : 0;
    return count;
  }

  GuiRun gui_;
};

TEST_F(SmallScreenTest, the_first_window_shows_its_status_bar) {
  gui_.screenshot("small_screen").then([](MainFrame& frame) {
    const wxSize screen = wxDisplay(0U).GetGeometry().GetSize();
    ASSERT_EQ(screen, wxSize(1500, 950));
    const wxRect bar = frame.GetStatusBar()->GetScreenRect();
    ASSERT_GT(bar.y, 0) << "the title bar of the window manager and the window lie above";
    EXPECT_LE(bar.GetBottom(), screen.y - 1);
    EXPECT_LE(bar.GetRight(), screen.x - 1);
    EXPECT_GT(dark_pixels(wxRect(bar.x, bar.y, bar.width / 2, bar.height)), 100) << "a hint";
  });
  EXPECT_EQ(gui_.run({}), 0);
}

}  // namespace
}  // namespace psi_slam
