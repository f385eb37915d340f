// SPDX-License-Identifier: BSD-3-Clause
// Tests the tools of the menu Edit > Map with clicks of the real mouse.
#include <gmock/gmock.h>
#include <wx/statusbr.h>

#include "../session/room_log.h"
#include "gui_run.h"
#include "map/report/output_folder.h"
#include "map_canvas.h"
#include "message_bar.h"
#include "psi_slam/mapping_session.h"
#include "same_results.h"
#include "session/edit_journal.h"
#include "speed_dialog.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;
using Kind = MapEdit::Kind;

int tool(Kind kind) {
  for (std::size_t i = 0; i < kMapTools.size(); ++i)
    if (kMapTools[i].kind == kind) return kMapTool + static_cast<int>(i);
  throw std::logic_error("no tool for this kind");
}

class MapEditsTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!GuiRun::has_display()) GTEST_SKIP() << "needs xvfb-run from Debian's package xvfb";
    log_ = write_lines(gui_.folder() / "room.log", room_log_lines(150)).string();
  }
  GuiRun& finish() {
    return gui_.when_phase(ReplayPhase::kPaused)
        .command(kSpeed + 3)
        .command(kPlayOrPause)
        .when_phase(ReplayPhase::kFinished)
        .when("the map is drawn",
              [](MainFrame& frame) {
                return frame.replay()->drawn_map() && frame.replay()->drawn_map()->scans == 150;
              })
        .pause(300);
  }
  GuiRun& click(double x_share, double y_share) {
    return gui_.mouse_to("map", x_share, y_share).mouse_down().mouse_up();
  }
  /// Draws a triangle, whose left upper corner is at this place of the map, and closes it with Enter.
  GuiRun& triangle(Kind kind, double x_share, double y_share) {
    gui_.command(tool(kind));
    click(x_share, y_share);
    click(x_share + 0.05, y_share);
    click(x_share + 0.05, y_share + 0.1);
    return gui_.key(WXK_RETURN);
  }
  GuiRun& when_edits(std::size_t count) {
    return gui_.when(std::to_string(count) + " edits", [count](MainFrame& frame) {
      return frame.replay()->snapshot()->edits->size() == count;
    });
  }
  GuiRun& when_zones(std::size_t count) {
    return gui_.when(std::to_string(count) + " kinds of zones", [count](MainFrame& frame) {
      return frame.replay()->drawn_map()->zones.size() == count;
    });
  }
  static std::string status(MainFrame& frame) { return frame.GetStatusBar()->GetStatusText().utf8_string(); }
  static const std::vector<MapEdit>& edits(MainFrame& frame) {
    return frame.replay()->snapshot()->edits->map_edits();
  }

  GuiRun gui_;
  std::string log_;
};

TEST_F(MapEditsTest, are_drawn_undone_saved_and_exported_like_psi_slam_does) {
  const std::filesystem::path saved = gui_.folder() / "my.edits";
  finish().command(tool(Kind::kErase));
  click(0.4, 0.4);
  click(0.46, 0.4);
  click(0.46, 0.5);
  gui_.mouse_to("map", 0.4, 0.52)
      .screenshot("map_erase_drawing")
      .then([](MainFrame& frame) {
        EXPECT_TRUE(frame.map().pointing());
        EXPECT_TRUE(frame.GetMenuBar()->IsChecked(tool(Kind::kErase)));
        EXPECT_THAT(status(frame), HasSubstr("Erase polygon: click its corners"));
      })
      .key(WXK_RETURN);
  when_edits(1).then([](MainFrame& frame) {
    EXPECT_FALSE(frame.map().pointing());
    EXPECT_EQ(edits(frame)[0].points.size(), 3U) << "the pointer is no corner";
    EXPECT_EQ(frame.replay()->snapshot()->phase, ReplayPhase::kFinished) << "the loops are kept";
  });
  triangle(Kind::kKeepOut, 0.5, 0.3);
  when_edits(2);
  when_zones(1);
  gui_.then([](MainFrame& frame) {
    frame.set_ask_for_speed([](const SpeedLimit& proposed) {
      EXPECT_EQ(proposed.percent, 0) << "there is no slow zone yet";
      return SpeedLimit{40, 0};
    });
  });
  triangle(Kind::kSlow, 0.5, 0.5);
  when_zones(2).screenshot("map_zones").command(kUndo);
  when_zones(1).then(
      [](MainFrame& frame) { EXPECT_THAT(status(frame), HasSubstr("Add slow zone of 40 %: undone")); });
  gui_.command(kRedo);
  when_zones(2).command(tool(Kind::kWall));
  click(0.42, 0.6);
  click(0.55, 0.62);
  gui_.mouse_to("map", 0.6, 0.55)
      .screenshot("map_wall_drawing")
      .mouse_down()
      .mouse_up()
      .mouse_down()
      .mouse_up();
  when_edits(4).then([](MainFrame& frame) {  // a double click ends the wall
    EXPECT_GE(edits(frame).back().points.size(), 3U);
  });
  gui_.command(tool(Kind::kCrop));
  click(0.3, 0.1);
  click(0.7, 0.1);
  click(0.7, 0.9);
  click(0.3, 0.9);
  gui_.then([](MainFrame&) { wxUIActionSimulator().MouseClick(wxMOUSE_BTN_RIGHT); });
  when_edits(5)
      .pause(500)
      .screenshot("map_cropped")
      .command(kQuit)
      .when("a question", [](MainFrame& frame) { return frame.messages().asks(); })
      .then([=](MainFrame& frame) {
        EXPECT_THAT(frame.messages().sentence(), HasSubstr("have not been exported or saved"));
        frame.messages().dismiss();
        frame.save_edits(saved);
        frame.export_to(gui_.folder() / "gui", false);
      })
      .close();
  EXPECT_EQ(gui_.run({log_}), 0);

  MappingSession session(log_, Settings());
  session.add_edits(EditJournal::read(saved));
  session.run(std::atomic<bool>(false));
  session.export_to(OutputFolder::prepare(gui_.folder() / "headless", false));
  expect_same_results(gui_.folder() / "headless", gui_.folder() / "gui");
  EXPECT_EQ(read_file(saved), read_file(gui_.folder() / "gui" / "loops.edits"));
  EXPECT_FALSE(read_file(gui_.folder() / "gui" / "speed_mask.pgm").empty());
}

TEST_F(MapEditsTest, can_be_cancelled_and_need_enough_points) {
  finish().command(tool(Kind::kErase));
  click(0.4, 0.4);
  click(0.5, 0.4);
  gui_.key(WXK_RETURN).then([](MainFrame& frame) {
    EXPECT_THAT(status(frame), HasSubstr("at least 3 points"));
    EXPECT_TRUE(frame.map().pointing());
  });
  click(0.5, 0.5);
  gui_.key(WXK_BACK).key(WXK_RETURN).then([](MainFrame& frame) {
    EXPECT_TRUE(frame.map().pointing()) << "only two points are left";
  });
  gui_.key(WXK_ESCAPE)
      .then([](MainFrame& frame) {
        EXPECT_FALSE(frame.map().pointing());
        EXPECT_FALSE(frame.GetMenuBar()->IsChecked(tool(Kind::kErase)));
        frame.set_ask_for_speed([](const SpeedLimit&) { return std::nullopt; });
      })
      .command(tool(Kind::kSlow))
      .then([](MainFrame& frame) { EXPECT_FALSE(frame.map().pointing()) << "no speed was given"; })
      .command(kAddLoop)
      .command(tool(Kind::kUnknown))
      .then([](MainFrame& frame) {
        EXPECT_TRUE(frame.map().pointing());
        EXPECT_FALSE(frame.GetMenuBar()->IsChecked(kAddLoop));
      })
      .command(tool(Kind::kUnknown))
      .then([](MainFrame& frame) {
        EXPECT_FALSE(frame.map().pointing()) << "choosing the tool again cancels it";
        EXPECT_TRUE(edits(frame).empty());
      });
  EXPECT_EQ(gui_.run({log_}), 0);
}

TEST_F(MapEditsTest, the_largest_speed_has_one_of_two_units) {
  SpeedDialog* dialog = nullptr;
  gui_.then([&](MainFrame& frame) {
        frame.SetSize(frame.FromDIP(wxSize(1000, 700)));
        dialog = new SpeedDialog(&frame, {});
        dialog->Show();
      })
      .screenshot("speed_dialog")
      .then([&](MainFrame& frame) {
        EXPECT_EQ(dialog->limit().percent, 30);
        EXPECT_EQ(dialog->limit().max_speed_mps, 0);
        dialog->choose_percent(false);
        EXPECT_EQ(dialog->limit().percent, 0);
        EXPECT_NEAR(dialog->limit().max_speed_mps, 0.3, 1e-9);
        dialog->Destroy();
        EXPECT_NEAR(SpeedDialog(&frame, {0, 0.25}).limit().max_speed_mps, 0.25, 1e-9);
        EXPECT_EQ(SpeedDialog(&frame, {45, 0}).limit().percent, 45);
      });
  EXPECT_EQ(gui_.run({}), 0);
}

}  // namespace
}  // namespace psi_slam
