// SPDX-License-Identifier: BSD-3-Clause
#include "main_frame.h"

#include <gmock/gmock.h>
#include <mrpt/opengl/CSetOfTriangles.h>
#include <wx/dnd.h>
#include <wx/statusbr.h>

#include <fstream>

#include "../session/room_log.h"
#include "gui/palette.h"
#include "gui_run.h"
#include "loop_canvas.h"
#include "loop_inspector.h"
#include "map/report/output_folder.h"
#include "map_canvas.h"
#include "message_bar.h"
#include "psi_slam/loop_record.h"
#include "psi_slam/mapping_session.h"
#include "same_results.h"
#include "session/edit_journal.h"
#include "session/settings.h"
#include "settings_panel.h"
#include "shared_logs.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;

class MainFrameTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!GuiRun::has_display()) GTEST_SKIP() << "needs xvfb-run from Debian's package xvfb";
  }
  std::string room_log(int scans = 150) {
    return write_lines(gui_.folder() / "room.log", room_log_lines(scans)).string();
  }
  static std::size_t scans(MainFrame& frame) {
    return frame.replay() ? frame.replay()->snapshot()->frames.size() : 0;
  }
  GuiRun& when_says(const std::string& words) {
    return gui_.when("\"" + words + "\" in the bar", [words](MainFrame& frame) {
      return frame.messages().sentence().find(words) != std::string::npos;
    });
  }

  GuiRun gui_;
};

TEST_F(MainFrameTest, without_a_log_shows_what_to_do) {
  gui_.screenshot("empty").then([](MainFrame& frame) {
    const wxWindow* const page = wxWindow::FindWindowByLabel("Open a log to build a map", &frame);
    ASSERT_NE(page, nullptr);
    EXPECT_TRUE(page->IsShownOnScreen());
    EXPECT_NE(wxWindow::FindWindowByLabel(wxString::FromUTF8("Open log…"), page->GetParent()), nullptr);
    EXPECT_FALSE(frame.map().IsShownOnScreen());
  });
  EXPECT_EQ(gui_.run({}), 0);
}

TEST_F(MainFrameTest, playing_pausing_and_stepping_gives_the_results_of_psi_slam) {
  const std::string log = room_log();
  MappingSession session(log, Settings());
  session.run(std::atomic<bool>(false));
  session.export_to(OutputFolder::prepare(gui_.folder() / "headless", false));

  std::size_t paused_at = 0;
  gui_.when_phase(ReplayPhase::kPaused)
      .screenshot("opened")
      .command(kSpeed + 2)  // 20 times as fast
      .command(kPlayOrPause)
      .when("40 scans", [](MainFrame& frame) { return scans(frame) >= 40; })
      .command(kPlayOrPause)
      .when_phase(ReplayPhase::kPaused)
      .then([&](MainFrame& frame) { paused_at = scans(frame); })
      .command(kStep)
      .when("one more scan", [&](MainFrame& frame) { return scans(frame) == paused_at + 1; })
      .screenshot("paused")
      .then([](MainFrame& frame) { frame.go_to(110); })
      .when("scan 110", [](MainFrame& frame) { return scans(frame) >= 111; })
      .command(kSpeed + 3)  // as fast as possible
      .command(kPlayOrPause)
      .when_phase(ReplayPhase::kFinished)
      .then([&](MainFrame& frame) { frame.export_to(gui_.folder() / "gui", false); })
      .close();  // the window closes when all results are written
  EXPECT_EQ(gui_.run({log}), 0);
  EXPECT_GE(paused_at, 40U);
  EXPECT_LT(paused_at, 110U) << "it was paused before scan 110";
  expect_same_results(gui_.folder() / "headless", gui_.folder() / "gui");
}

TEST_F(MainFrameTest, shows_details_and_a_picture_of_the_selected_loop) {
  gui_.when_phase(ReplayPhase::kPaused)
      .command(kPlayOrPause)
      .when_phase(ReplayPhase::kFinished)
      .when("the map is drawn",
            [](MainFrame& frame) {
              return frame.replay()->drawn_map() && frame.replay()->drawn_map()->scans == 150;
            })
      .when("loops are listed", [](MainFrame& frame) { return frame.loops().table().rows() > 3; })
      .screenshot("finished")
      .then([](MainFrame& frame) {
        EXPECT_TRUE(frame.loops().canvas().empty());
        frame.loops().select(frame.loops().table().loop_of(2));
      })
      .screenshot("loop")
      .then([](MainFrame& frame) {
        EXPECT_FALSE(frame.loops().canvas().empty());
        const LoopRecord& loop = frame.replay()->snapshot()->loops->at(frame.loops().table().loop_of(2));
        EXPECT_THAT(frame.loops().details(), HasSubstr(std::to_string(loop.frame)));
        EXPECT_THAT(frame.loops().details(), HasSubstr(state_text(loop.state)));
        EXPECT_TRUE(frame.GetMenuBar()->IsEnabled(kDeleteLoop));
      });
  EXPECT_EQ(gui_.run({room_log()}), 0);
}

TEST_F(MainFrameTest, shows_unmatched_scans) {
  auto lines = room_log_lines(80);
  for (std::size_t blind = 40; blind < 50; ++blind)
    lines[blind] = with_ranges(lines[blind], 0, kRoomBeams, "nan");
  const std::string log = write_lines(gui_.folder() / "room.log", lines).string();
  gui_.when_phase(ReplayPhase::kPaused).command(kPlayOrPause).when_phase(ReplayPhase::kFinished);
  when_says(" of 80 scans matched no local map").screenshot("unmatched").then([](MainFrame& frame) {
    const std::size_t count = frame.replay()->snapshot()->unmatched->count;
    EXPECT_GE(count, 10U);
    const std::string label = "Map finished: 80 scans, " + std::to_string(count) + " not matched";
    EXPECT_NE(wxWindow::FindWindowByLabel(label, &frame), nullptr);
  });
  EXPECT_EQ(gui_.run({log}), 0);
}

TEST_F(MainFrameTest, all_columns_of_the_loop_table_fit_into_a_small_window) {
  std::size_t rejected = 0;
  gui_.then([](MainFrame& frame) { frame.SetSize(frame.FromDIP(wxSize(1280, 800))); })
      .when_phase(ReplayPhase::kPaused)
      .command(kPlayOrPause)
      .when_phase(ReplayPhase::kFinished)
      .pause(200)
      .then([&](MainFrame& frame) {
        const LoopList& list = frame.loops().list();
        int all = 0;
        for (std::size_t column = 0; column < LoopTable::kColumns; ++column) {
          const int width = list.GetColumnWidth(static_cast<int>(column));
          all += width;
          EXPECT_GE(width, list.GetTextExtent(LoopTable::title(column)).GetWidth() + 8) << column;
          if (column == LoopTable::kReason) continue;
          for (std::size_t row = 0; row < list.table.rows(); ++row)
            EXPECT_GE(width, list.GetTextExtent(list.table.text(row, column)).GetWidth() + 8) << column;
        }
        EXPECT_LE(all, list.GetSize().GetWidth()) << "no horizontal scrolling is needed";
        const auto& loops = *frame.replay()->snapshot()->loops;
        while (rejected < loops.size() &&
               (loops[rejected].state != LoopState::kRejected || found_nothing(loops[rejected])))
          ++rejected;
        ASSERT_LT(rejected, loops.size());
        EXPECT_THAT(frame.loops().details(), HasSubstr("Select a loop"));
      })
      .screenshot("small_window")
      .then([&](MainFrame& frame) {
        frame.loops().select(rejected);
        const LoopRecord& loop = (*frame.replay()->snapshot()->loops)[rejected];
        EXPECT_THAT(frame.loops().details(), HasSubstr("rejected: " + text_of(loop.rejection)));
      })
      .screenshot("rejected_loop");
  EXPECT_EQ(gui_.run({room_log()}), 0);
}

TEST_F(MainFrameTest, a_legend_explains_the_colours_of_loops) {
  wxImage with;
  wxImage without;
  const auto take = [this](wxImage& into) {
    gui_.pause(300)
        .then([&into](MainFrame& frame) {
          frame.map().take_picture([&into](const wxImage& picture) { into = picture; });
        })
        .when("a picture is taken", [&into](MainFrame&) { return into.IsOk(); });
  };
  gui_.when_phase(ReplayPhase::kPaused)
      .then([](MainFrame& frame) {
        EXPECT_TRUE(frame.map().legend().entries.empty()) << "without loops there is no legend";
      })
      .command(kPlayOrPause)
      .when_phase(ReplayPhase::kFinished)
      .when("a legend", [](MainFrame& frame) { return !frame.map().legend().entries.empty(); })
      .command(kLoopsByResidual)
      .then([](MainFrame& frame) {
        EXPECT_EQ(frame.map().legend().title, "Loops, by residual");
        EXPECT_EQ(frame.map().legend().entries.back().name, "0.25 m and more");
      })
      .screenshot("residuals");
  take(with);
  gui_.command(kLayer + static_cast<int>(MapLayer::kLoops)).then([](MainFrame& frame) {
    EXPECT_TRUE(frame.map().legend().entries.empty());
  });
  take(without);
  EXPECT_EQ(gui_.run({room_log()}), 0);
  const auto count = [](const wxImage& picture, const mrpt::img::TColor& colour) {
    wxImageHistogram histogram;
    picture.ComputeHistogram(histogram);
    return histogram[wxImageHistogram::MakeKey(colour.R, colour.G, colour.B)].value;
  };
  const mrpt::img::TColor worst = heat_colour(1);
  EXPECT_GT(count(with, worst), 20UL) << "no loop has this colour, but the legend does";
  EXPECT_EQ(count(without, worst), 0UL);
}

const LoopRecord& selected_loop(MainFrame& frame) {
  return frame.replay()->snapshot()->loops->at(frame.loops().selected().value());
}

bool is_accepted(const LoopRecord& loop) {
  return loop.state == LoopState::kAccepted;
}

bool is_deleted(const LoopRecord& loop) {
  return rejected_by(loop, LoopRejection::Reason::kDeletedByHand);
}

void select_first_accepted(MainFrame& frame) {
  const auto& loops = *frame.replay()->snapshot()->loops;
  for (std::size_t i = 0; i < loops.size(); ++i)
    if (loops[i].state == LoopState::kAccepted) return frame.loops().select(i);
  FAIL() << "no loop was closed";
}

TEST_F(MainFrameTest, loops_can_be_deleted_matched_again_and_forced) {
  const std::string log = room_log();
  const std::filesystem::path edits = gui_.folder() / "my.edits";
  const auto selected_is = [](bool (*condition)(const LoopRecord&)) {
    return [condition](MainFrame& frame) {
      return frame.replay()->snapshot()->phase == ReplayPhase::kFinished && frame.loops().selected() &&
             condition(selected_loop(frame));
    };
  };
  gui_.when_phase(ReplayPhase::kPaused)
      .then([](MainFrame& frame) { frame.go_to(139); })
      .when("140 scans", [](MainFrame& frame) { return scans(frame) >= 140; })
      .when("a loop is listed", [](MainFrame& frame) { return frame.loops().table().rows() > 0; })
      .then([](MainFrame& frame) {
        EXPECT_FALSE(frame.GetMenuBar()->IsEnabled(kUndo));
        EXPECT_FALSE(frame.GetMenuBar()->IsEnabled(kDeleteLoop)) << "no loop is selected";
        select_first_accepted(frame);
      })
      .command(kDeleteLoop);
  when_says("Delete the loop of scan");
  gui_.screenshot("loop_deleted")
      .command(kUndo)
      .when("it is accepted again",
            [](MainFrame& frame) { return selected_loop(frame).state == LoopState::kAccepted; })
      .command(kRedo)
      .when("it is deleted again", [](MainFrame& frame) { return is_deleted(selected_loop(frame)); })
      .command(kSpeed + 3)
      .command(kPlayOrPause)
      .when("it survives the rest of the log", selected_is(is_deleted))
      .command(kMatchLoopBy + 2)
      .when("it is matched again", selected_is(is_accepted))
      .then([](MainFrame& frame) {
        EXPECT_EQ(selected_loop(frame).matcher, MatcherKind::kGa);
        EXPECT_TRUE(selected_loop(frame).by_hand);
      })
      .screenshot("loop_matched_again")
      .command(kForceLoop)
      .when("it is forced",
            [](MainFrame& frame) { return frame.replay()->snapshot()->undo_text.find("force") == 0; })
      .when_phase(ReplayPhase::kFinished)
      .then([&](MainFrame& frame) {
        frame.save_edits(edits);
        frame.export_to(gui_.folder() / "gui", false);
      })
      .close();
  EXPECT_EQ(gui_.run({log}), 0);

  MappingSession session(log, Settings());
  session.add_edits(EditJournal::read(edits));
  session.run(std::atomic<bool>(false));
  session.export_to(OutputFolder::prepare(gui_.folder() / "headless", false));
  expect_same_results(gui_.folder() / "headless", gui_.folder() / "gui");
  EXPECT_EQ(read_file(edits), read_file(gui_.folder() / "gui" / "loops.edits"));
}

TEST_F(MainFrameTest, two_clicks_add_a_loop) {
  gui_.when_phase(ReplayPhase::kPaused)
      .command(kSpeed + 3)
      .command(kPlayOrPause)
      .when_phase(ReplayPhase::kFinished)
      .when("the map is drawn", [](MainFrame& frame) { return frame.replay()->drawn_map() != nullptr; })
      .pause(500)
      .command(kAddLoop)
      .mouse_to("map", 0.5, 0.4)
      .mouse_down()
      .mouse_up()
      .mouse_to("map", 0.52, 0.42)
      .screenshot("adding_loop")
      .then([](MainFrame& frame) {
        EXPECT_TRUE(frame.map().pointing());
        EXPECT_THAT(frame.GetStatusBar()->GetStatusText().utf8_string(), HasSubstr("seen earlier"));
      })
      .mouse_down()
      .mouse_up()
      .when("it was matched", [](MainFrame& frame) { return frame.replay()->snapshot()->edited.has_value(); })
      .when_phase(ReplayPhase::kFinished);
  when_says("Match scan");
  gui_.then([](MainFrame& frame) {
        EXPECT_FALSE(frame.map().pointing());
        ASSERT_TRUE(frame.loops().selected().has_value());
        EXPECT_TRUE(selected_loop(frame).by_hand);
        EXPECT_EQ(selected_loop(frame).state, LoopState::kAccepted)
            << text_of(selected_loop(frame).rejection);
      })
      .screenshot("loop_added");
  EXPECT_EQ(gui_.run({room_log()}), 0);
}

TEST_F(MainFrameTest, edits_of_a_file_are_kept_after_a_restart) {
  const std::filesystem::path edits = gui_.folder() / "my.edits";
  std::ofstream(edits) << "delete scan=120 local_map=0\n";
  const std::filesystem::path wrong = gui_.folder() / "wrong.edits";
  std::ofstream(wrong) << "forget scan=120 local_map=0\n";
  const auto one_edit = [](MainFrame& frame) {
    return frame.replay()->snapshot()->edits->size() == 1 &&
           frame.replay()->snapshot()->phase == ReplayPhase::kPaused;
  };
  gui_.when_phase(ReplayPhase::kPaused).then([=](MainFrame& frame) { frame.open_edits(wrong); });
  when_says("wrong.edits:1: unknown edit \"forget\"");
  gui_.then([=](MainFrame& frame) { frame.open_edits(edits); })
      .when("there is an edit", one_edit)
      .command(kRestart)
      .when("it is still there", one_edit);
  EXPECT_EQ(gui_.run({room_log(40)}), 0);
}

TEST_F(MainFrameTest, failures_are_shown_in_the_message_bar) {
  const std::string corrupt = write_lines(gui_.folder() / "corrupt.log", {"FLASER 181 1.0 2.0"}).string();
  auto lines = room_log_lines(40);
  const std::string broken = write_lines(gui_.folder() / "broken.log", lines).string();
  std::ofstream(broken, std::ios::app) << "FLASER 181 1.0 2.0";
  when_says("missing.log does not exist")
      .screenshot("missing")
      .then([=](MainFrame& frame) { frame.open_log(corrupt); })
      .when_phase(ReplayPhase::kPaused)
      .command(kPlayOrPause);
  when_says("corrupt.log:1:");
  gui_.then([=](MainFrame& frame) { frame.open_log(broken); })
      .when_phase(ReplayPhase::kPaused)
      .command(kPlayOrPause)
      .when_phase(ReplayPhase::kFinished);
  when_says("broken.log:41:");
  gui_.then([&](MainFrame& frame) { frame.export_to(gui_.folder(), false); });
  when_says(gui_.folder().string());
  gui_.screenshot("not_empty").then([](MainFrame& frame) {
    EXPECT_TRUE(frame.messages().answer("Replace results"));
  });
  when_says("All results are in");
  EXPECT_EQ(gui_.run({(gui_.folder() / "missing.log").string()}), 0);
  EXPECT_TRUE(std::filesystem::exists(gui_.folder() / "report.html"));
}

TEST_F(MainFrameTest, a_log_deleted_while_it_is_open_is_mapped_to_its_end) {
  const std::string log = room_log();
  gui_.when_phase(ReplayPhase::kPaused)
      .then([=](MainFrame&) { std::filesystem::remove(log); })
      .command(kPlayOrPause)
      .when_phase(ReplayPhase::kFinished)
      .command(kRestart);
  when_says("does not exist");
  EXPECT_EQ(gui_.run({log}), 0);
}

TEST_F(MainFrameTest, closing_with_unsaved_work_asks_once) {
  gui_.when_phase(ReplayPhase::kPaused)
      .command(kSpeed)
      .command(kPlayOrPause)
      .when("some scans", [](MainFrame& frame) { return scans(frame) >= 2; })
      .close();
  when_says("have not been exported");
  gui_.close();
  EXPECT_EQ(gui_.run({room_log()}), 0);
}

TEST_F(MainFrameTest, asks_before_edits_are_lost) {
  const std::filesystem::path saved = gui_.folder() / "saved.edits";
  const std::filesystem::path others = gui_.folder() / "others.edits";
  std::ofstream(others) << "delete scan=120 local_map=0\n";
  const auto edits = [](MainFrame& frame) { return frame.replay()->snapshot()->edits->size(); };
  gui_.when_phase(ReplayPhase::kPaused)
      .command(kPlayOrPause)
      .when_phase(ReplayPhase::kFinished)
      .when("loops are listed", [](MainFrame& frame) { return frame.loops().table().rows() > 0; })
      .then([](MainFrame& frame) { select_first_accepted(frame); })
      .command(kDeleteLoop)
      .when("it was deleted", [=](MainFrame& frame) { return edits(frame) == 1; })
      .when_phase(ReplayPhase::kFinished)
      .command(kRestart)
      .when_phase(ReplayPhase::kPaused)
      .then([](MainFrame& frame) { EXPECT_EQ(scans(frame), 0U); })
      .command(kQuit);
  when_says("have not been exported");
  gui_.then([=](MainFrame& frame) {
    frame.messages().dismiss();
    frame.open_edits(others);
  });
  when_says("have not been saved");
  gui_.then([=](MainFrame& frame) {
        EXPECT_EQ(edits(frame), 1U);
        frame.set_ask_for_file([=](const FileQuestion&) { return saved; });
      })
      .command(kSaveEdits)
      .command(kQuit);  // closes without a question
  EXPECT_EQ(gui_.run({room_log()}), 0);
  EXPECT_EQ(EditJournal::read(saved).edits().size(), 1U);
}

TEST_F(MainFrameTest, scans_mapped_after_saving_a_session_count_as_unsaved) {
  gui_.when_phase(ReplayPhase::kPaused)
      .then([](MainFrame& frame) { frame.go_to(19); })
      .when("20 scans", [](MainFrame& frame) { return scans(frame) == 20; })
      .then([&](MainFrame& frame) { frame.save_session(gui_.folder() / "my.session"); });
  when_says("Session saved in");
  gui_.command(kStep)
      .when("one more scan", [](MainFrame& frame) { return scans(frame) == 21; })
      .command(kQuit);
  when_says("have not been exported");
  gui_.then([&](MainFrame& frame) { frame.save_session(gui_.folder() / "my.session"); });
  when_says("Session saved in");
  gui_.command(kQuit);
  EXPECT_EQ(gui_.run({room_log(40)}), 0);
}

TEST_F(MainFrameTest, after_finishing_early_an_edit_can_be_restored) {
  gui_.when_phase(ReplayPhase::kPaused)
      .then([](MainFrame& frame) { frame.go_to(139); })
      .when("140 scans", [](MainFrame& frame) { return scans(frame) == 140; })
      .command(kFinish)
      .when_phase(ReplayPhase::kFinished)
      .then([](MainFrame& frame) {
        EXPECT_EQ(scans(frame), 140U);
        EXPECT_TRUE(frame.replay()->snapshot()->interrupted);
        frame.go_to(145);
        EXPECT_THAT(frame.GetStatusBar()->GetStatusText().utf8_string(),
                    HasSubstr("finished after 140 scans"));
      })
      .when("loops are listed", [](MainFrame& frame) { return frame.loops().table().rows() > 0; })
      .then([](MainFrame& frame) { select_first_accepted(frame); })
      .command(kDeleteLoop)
      .when("it is deleted", [](MainFrame& frame) { return is_deleted(selected_loop(frame)); })
      .when_phase(ReplayPhase::kFinished)
      .command(kRestoreLoop)
      .when("it is restored",
            [](MainFrame& frame) { return selected_loop(frame).state == LoopState::kAccepted; })
      .when_phase(ReplayPhase::kFinished)
      .then([](MainFrame& frame) { EXPECT_EQ(scans(frame), 140U); });
  EXPECT_EQ(gui_.run({room_log()}), 0);
}

TEST_F(MainFrameTest, another_log_can_be_opened_while_one_is_mapped) {
  const std::string log = room_log();
  gui_.when_phase(ReplayPhase::kPaused);
  for (int i = 0; i < 3; ++i)
    gui_.command(kPlayOrPause)
        .then([=](MainFrame& frame) { frame.open_log(log); })
        .when_phase(ReplayPhase::kPaused);
  EXPECT_EQ(gui_.run({log}), 0);
}

TEST_F(MainFrameTest, settings_are_checked_saved_and_used) {
  const std::filesystem::path ini = gui_.folder() / "my.ini";
  gui_.when_phase(ReplayPhase::kPaused).then([](MainFrame& frame) {
    SettingsPanel& panel = frame.settings_panel();
    EXPECT_EQ(panel.shown("front_end.node_distance_m"), "0.2") << "given on the command line";
    EXPECT_TRUE(panel.enter("front_end.node_distance_m", "0.3"));
    EXPECT_FALSE(panel.enter("front_end.node_distance_m", "abc"));
    EXPECT_EQ(frame.settings().settings.mapper.front_end.node_distance_m, 0.3);
  });
  when_says("front_end.node_distance_m = abc: expected a number of metres");
  gui_.screenshot("settings")
      .then([&](MainFrame& frame) {
        EXPECT_TRUE(frame.settings_panel().enter("front_end.node_rotation_deg", "12"));
        frame.save_settings(ini);
        EXPECT_TRUE(frame.settings_panel().enter("loop_closure.enabled", "false"));
        EXPECT_TRUE(frame.settings_panel().enter("loop_closure.matcher", "ga"));
        frame.settings_panel().reset_all();
        EXPECT_EQ(frame.settings_panel().shown("front_end.node_rotation_deg"), "6");
        frame.open_settings(ini);
        EXPECT_EQ(frame.settings_panel().shown("front_end.node_distance_m"), "0.3");
      })
      .command(kRestart)
      .when_phase(ReplayPhase::kPaused)
      .then([](MainFrame& frame) {
        EXPECT_EQ(frame.replay()->settings().mapper.front_end.node_distance_m, 0.3);
      });
  EXPECT_EQ(gui_.run({room_log(20), "--set", "front_end.node_distance_m=0.2"}), 0);
  EXPECT_THAT(read_file(ini), HasSubstr("node_rotation_deg = 12"));
}

TEST_F(MainFrameTest, the_view_can_be_changed_and_saved_as_a_picture) {
  const std::filesystem::path picture = gui_.folder() / "view.png";
  gui_.when_phase(ReplayPhase::kPaused)
      .command(kPlayOrPause)
      .when_phase(ReplayPhase::kFinished)
      .command(kFollow)
      .then([](MainFrame& frame) { EXPECT_TRUE(frame.map().follows()); })
      .command(kFitMap)
      .then([](MainFrame& frame) {
        EXPECT_FALSE(frame.map().follows());
        frame.map().setElevationDegrees(40);
      })
      .command(kTopView)
      .then([](MainFrame& frame) { EXPECT_GT(frame.map().camera().elevation_deg, 89); })
      .pause(500)
      .then([&](MainFrame& frame) { frame.save_picture(picture); });
  when_says("Picture saved in");
  gui_.then([](MainFrame& frame) { frame.save_picture("/missing/view.png"); });
  when_says("/missing/view.png");
  EXPECT_EQ(gui_.run({room_log()}), 0);
  wxImage::AddHandler(new wxPNGHandler);
  const wxImage image(picture.string());
  ASSERT_TRUE(image.IsOk());
  EXPECT_GT(image.CountColours(), 10UL) << "the picture is not empty";
}

TEST_F(MainFrameTest, mouse_and_keys_play_measure_move_and_zoom) {
  MapCamera before;
  gui_.when_phase(ReplayPhase::kPaused)
      .mouse_to("play", 0.5, 0.5)
      .mouse_down()
      .mouse_up()
      .when_phase(ReplayPhase::kFinished)
      .when("the map is drawn", [](MainFrame& frame) { return frame.replay()->drawn_map() != nullptr; })
      .key('M')
      .mouse_to("map", 0.4, 0.5)
      .mouse_down()
      .mouse_to("map", 0.6, 0.5)
      .mouse_up()
      .screenshot("measured")
      .then([&](MainFrame& frame) {
        ASSERT_TRUE(frame.map().measure().has_value());
        const Measure measure = *frame.map().measure();
        EXPECT_GT(measure.distance_m(), 1);
        EXPECT_NEAR(measure.from.y, measure.to.y, 0.1) << "from left to right";
        EXPECT_THAT(frame.GetStatusBar()->GetStatusText().utf8_string(), HasSubstr(" m"));
        before = frame.map().camera();
      })
      .key('M')
      .mouse_to("map", 0.5, 0.5)
      .mouse_down()
      .mouse_to("map", 0.6, 0.5)
      .mouse_up()
      .then([&](MainFrame& frame) {
        EXPECT_LT(frame.map().camera().target.x, before.target.x) << "the map was moved to the right";
        EXPECT_NEAR(frame.map().camera().target.y, before.target.y, 0.1);
      })
      .then([&](MainFrame& frame) {
        wxKeyEvent plus(wxEVT_KEY_DOWN);
        plus.m_keyCode = '+';
        frame.map().GetEventHandler()->ProcessEvent(plus);
        EXPECT_LT(frame.map().camera().distance_m, before.distance_m);
      });
  EXPECT_EQ(gui_.run({room_log()}), 0);
}

TEST_F(MainFrameTest, a_dropped_log_is_listed_among_recent_logs) {
  const std::string log = room_log(20);
  gui_.then([=](MainFrame& frame) {
        auto* const target = dynamic_cast<wxFileDropTarget*>(frame.GetDropTarget());
        ASSERT_NE(target, nullptr);
        wxArrayString names;
        names.Add(log);
        EXPECT_TRUE(target->OnDropFiles(0, 0, names));
      })
      .when_phase(ReplayPhase::kPaused)
      .command(kStep)
      .when("one scan", [](MainFrame& frame) { return scans(frame) == 1; })
      .command(wxID_FILE1)
      .when("the log is opened again", [](MainFrame& frame) { return scans(frame) == 0; })
      .when_phase(ReplayPhase::kPaused);
  EXPECT_EQ(gui_.run({}), 0);
}

/// Tip of the arrow that shows the robot, in the map frame.
mrpt::math::TPoint2D drawn_robot(MainFrame& frame) {
  const auto& layer = frame.map().map_scene().layer(MapLayer::kRobot);
  const auto arrow = std::dynamic_pointer_cast<mrpt::opengl::CSetOfTriangles>(*layer.begin());
  mrpt::opengl::TTriangle triangle;
  arrow->getTriangle(0, triangle);
  return {static_cast<double>(triangle.x(0)), static_cast<double>(triangle.y(0))};
}

mrpt::math::TPoint2D map_T_robot(MainFrame& frame, std::size_t scan) {
  const mrpt::math::TPose2D pose = frame.replay()->snapshot()->frames[scan].map_T_robot;
  return {pose.x, pose.y};
}

TEST_F(MainFrameTest, an_earlier_scan_can_be_shown) {
  gui_.when_phase(ReplayPhase::kPaused)
      .command(kPlayOrPause)
      .when_phase(ReplayPhase::kFinished)
      .then([](MainFrame& frame) { frame.go_to(30); })
      .command(kLayer + static_cast<int>(MapLayer::kNodes))
      .screenshot("earlier_scan")
      .then([](MainFrame& frame) {
        EXPECT_EQ(scans(frame), 150U);
        EXPECT_TRUE(frame.map().map_scene().visible(MapLayer::kNodes));
        EXPECT_LT((drawn_robot(frame) - map_T_robot(frame, 30)).norm(), 0.6);
      })
      .then([](MainFrame& frame) { frame.go_to(149); })
      .then([](MainFrame& frame) {
        EXPECT_LT((drawn_robot(frame) - map_T_robot(frame, 149)).norm(), 0.6)
            << "the newest scan is shown again";
      });
  EXPECT_EQ(gui_.run({room_log()}), 0);
}

TEST_F(MainFrameTest, at_200_percent_scaling_everything_is_twice_as_large) {
  setenv("GDK_SCALE", "2", 1);
  wxImage picture;
  gui_.when_phase(ReplayPhase::kPaused)
      .command(kPlayOrPause)
      .when_phase(ReplayPhase::kFinished)
      .when("the map is drawn", [](MainFrame& frame) { return frame.replay()->drawn_map() != nullptr; })
      .then([](MainFrame& frame) { frame.SetSize(1400, 880); })
      .screenshot("scaling_200")
      .then([&](MainFrame& frame) {
        EXPECT_EQ(frame.GetContentScaleFactor(), 2);
        frame.map().take_picture([&](const wxImage& taken) { picture = taken; });
      })
      .when("a picture of the map", [&](MainFrame&) { return picture.IsOk(); })
      .then([&](MainFrame& frame) {
        EXPECT_EQ(picture.GetSize(), 2 * frame.map().GetClientSize()) << "in pixels of the screen";
      });
  EXPECT_EQ(gui_.run({room_log()}), 0);
}

TEST_F(MainFrameTest, shows_ellipses_of_uncertainty) {
  gui_.when_phase(ReplayPhase::kPaused)
      .command(kPlayOrPause)
      .when_phase(ReplayPhase::kFinished)
      .when("the map is drawn", [](MainFrame& frame) { return frame.replay()->drawn_map() != nullptr; })
      .command(kLayer + static_cast<int>(MapLayer::kUncertainty))
      .command(kLayer + static_cast<int>(MapLayer::kLoops))
      .screenshot("uncertainty")
      .then([](MainFrame& frame) {
        const auto& ellipses = frame.map().map_scene().layer(MapLayer::kUncertainty);
        EXPECT_NE(ellipses.begin(), ellipses.end());
      });
  EXPECT_EQ(gui_.run({room_log()}), 0);
}

TEST_F(MainFrameTest, shows_the_help_of_an_option_and_the_about_box) {
  gui_.mouse_to("settings", 0.3, 0.25)
      .mouse_down()
      .mouse_up()
      .screenshot("option")
      .command(kAbout)
      .screenshot("about");
  EXPECT_THAT(about_info().GetDescription().utf8_string(), HasSubstr("graph SLAM"));
  EXPECT_EQ(gui_.run({}), 0);
}

TEST_F(MainFrameTest, shows_a_benchmark_log) {
  const auto log = shared_file("fr079.clf.gz");
  if (!log) GTEST_SKIP() << kNeedsData;
  gui_.when_phase(ReplayPhase::kPaused)
      .command(kLayer + static_cast<int>(MapLayer::kLocalMaps))
      .command(kPlayOrPause)
      .when("half of it", [](MainFrame& frame) { return scans(frame) > 2500; })
      .command(kPlayOrPause)
      .when_phase(ReplayPhase::kPaused)
      .pause(1500)
      .then([](MainFrame& frame) { EXPECT_GT(frame.replay()->snapshot()->loops->size(), 10U); })
      .then([](MainFrame& frame) {
        const std::vector<LoopRecord>& loops = *frame.replay()->snapshot()->loops;
        std::size_t far = 0;  // the accepted loop with the largest correction
        double farthest_m = 0;
        for (std::size_t i = 0; i < loops.size(); ++i) {
          const mrpt::math::TPose2D moved = loops[i].anchor_T_node - loops[i].anchor_T_predicted;
          if (loops[i].state != LoopState::kAccepted || moved.norm() <= farthest_m) continue;
          far = i;
          farthest_m = moved.norm();
        }
        EXPECT_GT(farthest_m, 0);
        frame.loops().select(far);
      })
      .screenshot("benchmark_loop")
      .command(kFitMap)
      .screenshot("benchmark_log")
      .command(kFollow)
      .screenshot("benchmark_follow");
  EXPECT_EQ(gui_.run({log->string()}), 0);
}

}  // namespace
}  // namespace psi_slam
