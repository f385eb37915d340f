// SPDX-License-Identifier: BSD-3-Clause
// Tests the window while it maps a live source.
#include <gmock/gmock.h>
#include <wx/statusbr.h>

#include "../session/room_log.h"
#include "gui_run.h"
#include "map/report/output_folder.h"
#include "message_bar.h"
#include "psi_slam/mapping_session.h"
#include "same_results.h"
#include "sender.h"
#include "session/settings.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;

class LiveWindow : public testing::Test {
 protected:
  void SetUp() override {
    if (!GuiRun::has_display()) GTEST_SKIP() << "needs xvfb-run from Debian's package xvfb";
  }
  GuiRun& when_scans(std::size_t count) {
    return gui_.when(std::to_string(count) + " scans", [count](MainFrame& frame) {
      return frame.replay()->snapshot()->frames.size() == count;
    });
  }
  GuiRun& when_asks() {
    return gui_.when("a question", [](MainFrame& frame) { return frame.messages().asks(); });
  }
  static std::string status(MainFrame& frame, int field) {
    return frame.GetStatusBar()->GetStatusText(field).utf8_string();
  }

  GuiRun gui_;
};

TEST_F(LiveWindow, maps_a_tcp_stream_until_it_is_disconnected) {
  const std::vector<std::string> lines = room_log_lines();
  Descriptor connection;
  const auto send = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) send_text(connection.number(), lines[i] + '\n');
  };
  const std::filesystem::path journal = gui_.folder() / "session.journal";
  gui_.then([&](MainFrame& frame) {
        frame.set_ask_for_port([] { return std::uint16_t{0}; });
        frame.set_ask_for_file([&](const FileQuestion& question) {
          EXPECT_EQ(question.proposed_name, "session.journal");
          return journal;
        });
      })
      .command(kConnectTcp)
      .when("a port", [](MainFrame& frame) { return port_in(frame.replay()->live_figures()->notice) != 0; })
      .then([&](MainFrame& frame) {
        connection = connect_to(port_in(frame.replay()->live_figures()->notice));
        send(0, 100);
      });
  when_scans(100)
      .when("a sender", [](MainFrame& frame) { return status(frame, 0).find("Connected to") == 0; })
      .screenshot("live")
      .then([&](MainFrame& frame) {
        EXPECT_TRUE(std::filesystem::exists(journal));
        EXPECT_THAT(status(frame, 1), HasSubstr("missed deadline"));
        EXPECT_THAT(status(frame, 1), HasSubstr("ms, largest"));
        for (const int command : {kPlayOrPause, kStep, kRestart, kConnectTcp, kOpenEdits})
          EXPECT_FALSE(frame.GetMenuBar()->IsEnabled(command)) << command;
        for (const int command : {kDisconnect, kFinish, kSaveSession, kAddLoop})
          EXPECT_TRUE(frame.GetMenuBar()->IsEnabled(command)) << command;
        GuiRun::choose(frame, kQuit);
      });
  when_asks().then([&](MainFrame& frame) {
    EXPECT_THAT(frame.messages().sentence(), HasSubstr("Close the window anyway?"));
    frame.messages().dismiss();
    send(100, 150);
  });
  when_scans(150)
      .command(kDisconnect)
      .when_phase(ReplayPhase::kFinished)
      .then([&](MainFrame& frame) {
        EXPECT_FALSE(frame.replay()->snapshot()->interrupted);
        frame.export_to(gui_.folder() / "live", false);
      })
      .when("the menu follows",
            [](MainFrame& frame) {
              return frame.GetMenuBar()->IsEnabled(kConnectTcp) &&
                     !frame.GetMenuBar()->IsEnabled(kDisconnect);
            })
      .close();  // the window closes when all results are written
  EXPECT_EQ(gui_.run({}), 0);
  EXPECT_FALSE(std::filesystem::exists(journal));

  MappingSession session(write_lines(gui_.folder() / "room.log", lines), Settings());
  session.run(std::atomic<bool>(false));
  session.export_to(OutputFolder::prepare(gui_.folder() / "headless", false));
  expect_same_results(gui_.folder() / "headless", gui_.folder() / "live");
}

TEST_F(LiveWindow, follows_the_log_of_the_command_line_and_asks_before_the_map_is_lost) {
  const std::string log = write_lines(gui_.folder() / "room.log", room_log_lines(40)).string();
  gui_.when("a live source", [](MainFrame& frame) { return frame.replay()->live_figures().has_value(); })
      .when_phase(ReplayPhase::kFinished);
  when_scans(40).then([=](MainFrame& frame) { frame.open_other_log(log); });
  when_asks()
      .then([](MainFrame& frame) {
        EXPECT_THAT(frame.messages().sentence(), HasSubstr("The live map has not been exported or saved"));
        EXPECT_TRUE(frame.messages().answer("Open it"));
      })
      .when_phase(ReplayPhase::kPaused)
      .when("the window follows", [](MainFrame& frame) {
        return frame.GetStatusBar()->GetFieldsCount() == 1 && frame.GetMenuBar()->IsEnabled(kPlayOrPause);
      });
  EXPECT_EQ(gui_.run({"--follow", log, "--idle-s", "0.2"}), 0);
}

TEST_F(LiveWindow, follows_the_folder_of_a_bag) {
  const std::filesystem::path bag = gui_.folder() / "run";
  std::filesystem::create_directory(bag);
  gui_.then([&](MainFrame& frame) {
        frame.set_ask_for_file([&](const FileQuestion& question) {
          return question.kind == FileQuestion::Kind::kFolder ? bag : gui_.folder() / "session.journal";
        });
      })
      .command(kConnectFolder)
      .when("a live source",
            [](MainFrame& frame) { return frame.replay() && frame.replay()->live_figures().has_value(); })
      .then([](MainFrame& frame) { EXPECT_FALSE(frame.GetMenuBar()->IsEnabled(kConnectFolder)); })
      .close();
  EXPECT_EQ(gui_.run({}), 0);
}

TEST_F(LiveWindow, closes_at_once_while_a_source_is_silent) {
  gui_.when("a port",
            [](MainFrame& frame) {
              return frame.replay() && port_in(frame.replay()->live_figures()->notice) != 0;
            })
      .close();
  EXPECT_EQ(gui_.run({"--tcp", "0"}), 0);
}

}  // namespace
}  // namespace psi_slam
