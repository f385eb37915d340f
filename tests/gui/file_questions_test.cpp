// SPDX-License-Identifier: BSD-3-Clause
// Tests the commands of the File menu with prepared answers to their file dialogs.
#include <gmock/gmock.h>

#include <deque>

#include "../session/room_log.h"
#include "gui_run.h"
#include "map/report/output_folder.h"
#include "message_bar.h"
#include "psi_slam/mapping_session.h"
#include "session/settings.h"
#include "settings_panel.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;
using Answer = std::optional<std::filesystem::path>;

class FileQuestionsTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!GuiRun::has_display()) GTEST_SKIP() << "needs xvfb-run from Debian's package xvfb";
    gui_.then([this](MainFrame& frame) {
      frame.set_ask_for_file([this](const FileQuestion& question) -> Answer {
        asked_.push_back(question);
        EXPECT_FALSE(answers_.empty()) << question.title;
        const Answer answer = answers_.empty() ? std::nullopt : answers_.front();
        if (!answers_.empty()) answers_.pop_front();
        return answer;
      });
    });
  }
  std::filesystem::path path(const std::string& name) const { return gui_.folder() / name; }
  /// Chooses a command and answers its file dialog.
  GuiRun& command(int id, const Answer& answer) {
    gui_.then([this, answer](MainFrame& frame) {
      frame.messages().dismiss();
      answers_.push_back(answer);
    });
    return gui_.command(id);
  }
  void until_it_says(const std::string& words) {
    gui_.when("\"" + words + "\" in the bar", [words](MainFrame& frame) {
      return frame.messages().sentence().find(words) != std::string::npos;
    });
  }
  /// Maps a short log to its end.
  void map_room() {
    const auto log = write_lines(path("room.log"), room_log_lines(20));
    command(kOpenLog, log)
        .when_phase(ReplayPhase::kPaused)
        .command(kPlayOrPause)
        .when_phase(ReplayPhase::kFinished);
  }

  GuiRun gui_;
  std::deque<Answer> answers_;
  std::vector<FileQuestion> asked_;
};

TEST_F(FileQuestionsTest, open_export_and_save_picture_use_the_chosen_files) {
  map_room();
  command(kExport, path("results"));
  until_it_says("All results are in");
  write_file(path("view.png"), "an older file");
  command(kSavePicture, path("view.png"));
  until_it_says("Picture saved in");
  EXPECT_EQ(gui_.run({}), 0);
  EXPECT_TRUE(std::filesystem::exists(path("results") / "report.html"));
  EXPECT_THAT(read_file(path("view.png")), HasSubstr("PNG"));
  ASSERT_EQ(asked_.size(), 3U);
  EXPECT_EQ(asked_[0].kind, FileQuestion::Kind::kOpen);
  EXPECT_EQ(asked_[1].kind, FileQuestion::Kind::kFolder);
  EXPECT_EQ(asked_[2].kind, FileQuestion::Kind::kSave);
  EXPECT_EQ(asked_[2].proposed_name, "view.png");
}

TEST_F(FileQuestionsTest, a_session_saved_half_way_can_be_opened_and_resumed) {
  const auto log = write_lines(path("room.log"), room_log_lines(40));
  command(kOpenLog, log).when_phase(ReplayPhase::kPaused);
  for (int i = 0; i < 25; ++i) gui_.command(kStep);
  gui_.when("25 scans", [](MainFrame& frame) {
    return frame.replay()->snapshot()->frames.size() == 25 &&
           frame.replay()->snapshot()->phase == ReplayPhase::kPaused;
  });
  command(kSaveSession, path("half.session"));
  until_it_says("Session saved in");
  gui_.then([](MainFrame& frame) { frame.settings_panel().enter("front_end.node_distance_m", "0.7"); });
  command(kOpenLog, path("half.session"))
      .when("25 scans again",
            [](MainFrame& frame) {
              return frame.replay()->stamps_us() && frame.replay()->stamps_us()->size() == 25;
            })
      .then([](MainFrame& frame) {
        EXPECT_NE(frame.settings_panel().shown("front_end.node_distance_m"), "0.7")
            << "the session has its own settings";
        EXPECT_THAT(std::string(frame.GetTitle().utf8_string()), HasSubstr("half.session"));
      });
  command(kResumeWithLog, path("none.log"));
  until_it_says("none.log does not exist");
  command(kResumeWithLog, log)
      .when("40 scans again",
            [](MainFrame& frame) {
              return frame.replay()->stamps_us() && frame.replay()->stamps_us()->size() == 40;
            })
      .command(kPlayOrPause)
      .when_phase(ReplayPhase::kFinished)
      .then([](MainFrame& frame) {
        EXPECT_EQ(frame.replay()->snapshot()->frames.size(), 40U);
        frame.settings_panel().enter("front_end.node_distance_m", "0.7");
      })
      .command(kRestart);
  until_it_says("front_end.node_distance_m is");
  write_file(path("my.edits"), "delete scan=3 local_map=0\n");
  gui_.then([this](MainFrame& frame) { frame.messages().dismiss(), frame.open_edits(path("my.edits")); });
  until_it_says("front_end.node_distance_m is");
  EXPECT_EQ(gui_.run({}), 0);
}

TEST_F(FileQuestionsTest, edits_made_while_a_session_is_read_are_not_lost) {
  const auto log = write_lines(path("room.log"), room_log_lines(40));
  {
    MappingSession session(log, Settings());
    session.run(std::atomic<bool>(false));
    session.save(path("my.session"));
  }
  const LoopEdit edit{LoopEdit::Kind::kDelete, 30, 0};
  command(kOpenLog, path("my.session"))
      .when("it is open", [](MainFrame& frame) { return frame.replay() && frame.replay()->stamps_us(); })
      .when_phase(ReplayPhase::kPaused)
      .then([=](MainFrame& frame) {
        frame.resume_with(log);
        frame.replay()->edit(edit);  // may take effect before the log is compared with the session
      })
      .when("the session is resumed with the log",
            [=](MainFrame& frame) {
              if (frame.messages().sentence().find("still in progress") != std::string::npos)
                frame.resume_with(log);
              return frame.replay()->log() == log;
            })
      .then([](MainFrame& frame) { EXPECT_EQ(frame.replay()->snapshot()->edits->size(), 1U); })
      .then([this](MainFrame& frame) {
        frame.open_log(path("my.session"));
        frame.replay()->edit({LoopEdit::Kind::kDelete, 31, 0});
      });
  until_it_says("Edits were made while");
  gui_.then([](MainFrame& frame) { EXPECT_TRUE(frame.messages().answer("Open it")); })
      .when("the session alone", [](MainFrame& frame) { return frame.replay()->log().empty(); });
  EXPECT_EQ(gui_.run({}), 0);
}

TEST_F(FileQuestionsTest, a_damaged_session_is_reported_and_the_map_stays) {
  map_room();
  write_file(path("broken.session"), "psi-slam session and then nothing");
  command(kOpenLog, path("broken.session"));
  until_it_says("broken.session is");
  gui_.then([](MainFrame& frame) { EXPECT_EQ(frame.replay()->snapshot()->frames.size(), 20U); });
  EXPECT_EQ(gui_.run({}), 0);
}

TEST_F(FileQuestionsTest, settings_are_opened_and_saved_over_a_file) {
  write_file(path("my.ini"), "[front_end]\nnode_distance_m = 0.7\n");
  command(kOpenSettings, path("my.ini")).then([](MainFrame& frame) {
    EXPECT_EQ(frame.settings_panel().shown("front_end.node_distance_m"), "0.7");
    EXPECT_TRUE(frame.settings_panel().enter("front_end.node_distance_m", "0.4"));
  });
  command(kSaveSettings, path("my.ini"));
  until_it_says("Settings saved in");
  write_file(path("wrong.ini"), "[front_end]\nwindow_metres = 1\n");
  command(kOpenSettings, path("wrong.ini"));
  until_it_says("window_metres");
  EXPECT_EQ(gui_.run({}), 0);
  EXPECT_THAT(read_file(path("my.ini")), HasSubstr("node_distance_m = 0.4"));
}

TEST_F(FileQuestionsTest, the_folder_of_a_bag_is_opened_as_a_log) {
  std::filesystem::create_directory(path("empty_bag"));
  command(kOpenFolder, path("empty_bag"));
  until_it_says("empty_bag");
  EXPECT_EQ(gui_.run({}), 0);
  ASSERT_EQ(asked_.size(), 1U);
  EXPECT_EQ(asked_[0].kind, FileQuestion::Kind::kFolder);
}

TEST_F(FileQuestionsTest, a_cancelled_dialog_changes_nothing) {
  const auto expect_no_message = [](MainFrame& frame) { EXPECT_EQ(frame.messages().sentence(), ""); };
  command(kOpenLog, std::nullopt).then([](MainFrame& frame) { EXPECT_FALSE(frame.replay()); });
  for (const int id : {kOpenFolder, kOpenSettings, kSaveSettings})
    command(id, std::nullopt).then(expect_no_message);
  map_room();
  for (const int id : {kExport, kSavePicture}) command(id, std::nullopt).pause(200).then(expect_no_message);
  EXPECT_EQ(gui_.run({}), 0);
  EXPECT_EQ(asked_.size(), 7U);
}

TEST_F(FileQuestionsTest, failures_to_write_are_reported) {
  write_file(path("plain"), "not a folder");
  command(kSaveSettings, path("plain") / "my.ini");
  until_it_says("plain");
  map_room();
  command(kExport, path("plain") / "results");
  until_it_says("plain");
  command(kExport, path("plain"));
  until_it_says("plain");
  command(kSavePicture, path("plain") / "view.png");
  until_it_says("plain");
  EXPECT_EQ(gui_.run({}), 0);
  EXPECT_EQ(read_file(path("plain")), "not a folder");
}

}  // namespace
}  // namespace psi_slam
