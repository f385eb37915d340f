// SPDX-License-Identifier: BSD-3-Clause
// Tests that a run that is interrupted, saved and resumed gives the same results as one without interruption.
#include <gmock/gmock.h>

#include <algorithm>
#include <sstream>

#include "frames_in_memory.h"
#include "logs/frames/discarded_ranges.h"
#include "map/exports/run_summary.h"
#include "map/report/output_folder.h"
#include "psi_slam/mapping_session.h"
#include "psi_slam/open_log.h"
#include "psi_slam/user_error.h"
#include "room_log.h"
#include "same_results.h"
#include "session/recorded_settings.h"
#include "session/session_file.h"
#include "session/session_input.h"
#include "session/settings.h"
#include "simulated_run.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
namespace fs = std::filesystem;

class ResumedSession : public testing::Test {
 protected:
  fs::path log(const std::string& name, const std::vector<std::string>& lines) {
    return write_lines(folder_.path() / name, lines);
  }

  fs::path export_of(MappingSession& session, const std::string& name) {
    session.export_to(OutputFolder::prepare(folder_.path() / name, false));
    return folder_.path() / name;
  }

  fs::path uninterrupted(const fs::path& log, const EditJournal& edits = {}) {
    MappingSession session(log, settings_);
    session.add_edits(edits);
    session.run(go_on_);
    return export_of(session, "uninterrupted");
  }

  /// Maps the first `scans` scans of the log and saves the session.
  fs::path saved_after(std::size_t scans, const fs::path& log, const EditJournal& edits = {}) {
    MappingSession session(log, settings_);
    session.add_edits(edits);
    for (std::size_t i = 0; i < scans; ++i) session.step();
    session.finish();
    session.save(saved_);
    return saved_;
  }

  SessionInput resumed(const fs::path& log = {}) const {
    return SessionInput(std::make_shared<const SessionRecording>(read_session_file(saved_)), log);
  }

  TemporaryFolder folder_;
  const fs::path saved_ = folder_.path() / "saved.session";
  Settings settings_;
  const std::atomic<bool> go_on_{false};
};

TEST_F(ResumedSession, resuming_the_same_log_gives_the_same_bytes_on_any_number_of_threads) {
  const auto path = log("room.log", room_log_lines());
  const fs::path whole = uninterrupted(path);
  saved_after(70, path);
  for (const int threads : {1, 3}) {
    settings_.run.threads = threads;
    MappingSession session(resumed(path), settings_);
    session.run(go_on_);
    EXPECT_FALSE(session.result().interrupted);
    EXPECT_EQ(session.result().frames.size(), 150U);
    expect_same_results(whole, export_of(session, "resumed" + std::to_string(threads)));
  }
}

TEST_F(ResumedSession, holds_the_scans_that_later_passes_supersede) {
  const auto path = log("rounds.log", room_log_lines(1000));
  MappingSession session(path, settings_);
  session.run(go_on_);
  const std::vector<Frame>& mapped = session.result().log;
  ASSERT_FALSE(std::all_of(mapped.begin(), mapped.end(), has_ranges)) << "the robot makes ten rounds";
  session.save(saved_);
  const fs::path whole = export_of(session, "whole");
  const SessionRecording recording = read_session_file(saved_);
  EXPECT_TRUE(std::all_of(recording.frames.begin(), recording.frames.end(), has_ranges));
  for (const int threads : {1, 3}) {
    settings_.run.threads = threads;
    MappingSession again(resumed(), settings_);
    again.run(go_on_);
    expect_same_results(export_of(again, "again" + std::to_string(threads)), whole);
  }
}

TEST_F(ResumedSession, gives_the_same_map_wherever_it_was_saved) {
  const auto path = log("room.log", room_log_lines(60));
  const fs::path whole = uninterrupted(path);
  for (const std::size_t scans : {1U, 59U, 60U}) {
    saved_after(scans, path);
    MappingSession session(resumed(path), settings_);
    session.run(go_on_);
    expect_same_results(whole, export_of(session, "resumed" + std::to_string(scans)));
  }
}

TEST_F(ResumedSession, gives_the_same_map_of_sweeps_without_odometry) {
  settings_.log.odometry = "none";
  settings_.log.sweep_time_s = 0.15;
  const auto path = log("room.log", room_log_lines(60));
  const fs::path whole = uninterrupted(path);
  for (const std::size_t scans : {30U, 60U}) {
    saved_after(scans, path);
    MappingSession session(resumed(path), settings_);
    session.run(go_on_);
    expect_same_results(whole, export_of(session, "resumed" + std::to_string(scans)));
  }
  settings_.log.sweep_time_s = 0;
  MappingSession without(path, settings_);
  without.run(go_on_);
  EXPECT_NE(read_file(export_of(without, "without") / "trajectory.tum"), read_file(whole / "trajectory.tum"))
      << "without an effect of the sweep the test would show nothing";
}

TEST_F(ResumedSession, gives_the_same_map_of_a_robot_that_stands_for_long) {
  const auto path = log("room.log", standing_log_lines(20, 250, 30));
  for (const char* odometry : {"auto", "none"}) {
    settings_.log.odometry = odometry;
    settings_.log.sweep_time_s = 0.15;
    MappingSession whole(path, settings_);
    whole.run(go_on_);
    const fs::path expected = export_of(whole, std::string("uninterrupted-") + odometry);
    for (const std::size_t scans : {200U, 290U}) {
      saved_after(scans, path);
      const std::vector<Frame> frames = read_session_file(saved_).frames;
      const auto kept = std::count_if(frames.begin(), frames.end(), has_ranges);
      EXPECT_LT(static_cast<std::size_t>(kept), scans - 40) << "otherwise the test would show nothing";
      MappingSession session(resumed(path), settings_);
      session.run(go_on_);
      expect_same_results(expected, export_of(session, odometry + std::to_string(scans)));
    }
  }
}

TEST_F(ResumedSession, continues_with_a_second_log_as_if_both_were_one) {
  const auto lines = room_log_lines();
  const auto half = lines.begin() + 80;
  const auto first = log("first.log", {lines.begin(), half});
  const auto second = log("second.log", {half, lines.end()});
  const fs::path whole = uninterrupted(log("room.log", lines));
  saved_after(80, first);
  MappingSession session(resumed(second), settings_);
  session.run(go_on_);
  expect_same_results(whole, export_of(session, "resumed"));
  EXPECT_EQ(session.run_info().log_name, "first.log + second.log");

  session.save(saved_);  // saves the session again, now with both logs
  MappingSession again(resumed(), settings_);
  again.run(go_on_);
  expect_same_results(whole, export_of(again, "again"));
  EXPECT_THAT(sentence_of([&] { resumed(first); }), HasSubstr("first.log is already in the session"));
}

TEST_F(ResumedSession, without_a_log_it_gives_the_same_results) {
  const auto path = log("room.log", room_log_lines());
  MappingSession session(path, settings_);
  for (int i = 0; i < 90; ++i) session.step();
  session.finish();
  session.save(saved_);
  const fs::path before = export_of(session, "before");
  fs::remove(path);
  MappingSession alone(resumed(), settings_);
  alone.run(go_on_);
  expect_same_results(before, export_of(alone, "alone"));
  EXPECT_EQ(alone.run_info().log_name, "room.log");
  EXPECT_TRUE(alone.result().interrupted) << "the log has more scans";
}

TEST_F(ResumedSession, keeps_edits_and_accepts_further_ones) {
  const auto path = log("room.log", room_log_lines());
  MappingSession plain(path, settings_);
  plain.run(go_on_);
  EditJournal early;
  EditJournal late;
  for (const LoopRecord& loop : plain.result().loops)
    if (loop.state == LoopState::kAccepted)
      (loop.frame < 130 ? early : late).add({{LoopEdit::Kind::kDelete, loop.frame, loop.local_map}, {}});
  ASSERT_FALSE(early.empty());
  ASSERT_FALSE(late.empty());
  EditJournal all = early;
  all.add(late);
  const fs::path whole = uninterrupted(path, all);
  saved_after(125, path, early);
  MappingSession session(resumed(path), settings_);
  session.add_edits(late);
  session.run(go_on_);
  expect_same_results(whole, export_of(session, "resumed"));
}

TEST_F(ResumedSession, an_interruption_while_replaying_loses_nothing) {
  const auto path = log("room.log", room_log_lines());
  const fs::path whole = uninterrupted(path);
  saved_after(100, path);
  MappingSession session(resumed(path), settings_);
  for (int i = 0; i < 30; ++i) session.step();
  session.finish();
  session.save(saved_);
  EXPECT_EQ(read_session_file(saved_).frames.size(), 100U);
  MappingSession again(resumed(path), settings_);
  again.run(go_on_);
  expect_same_results(whole, export_of(again, "again"));
}

/// Maps a part of a log with a journal, and ends as a crash does: without finishing or saving.
class ResumedJournal : public ResumedSession {
 protected:
  void crash_after(std::size_t scans, const SessionInput& input, const EditJournal& edits = {}) {
    MappingSession session(input, settings_);
    session.add_edits(edits);
    session.start_journal(saved_);
    for (std::size_t i = 0; i < scans; ++i) session.step();
  }

  void expect_resumed(const fs::path& whole, const fs::path& log) {
    MappingSession session(resumed(log), settings_);
    session.run(go_on_);
    expect_same_results(whole, export_of(session, "resumed" + std::to_string(++resumed_)));
  }

  int resumed_ = 0;
};

TEST_F(ResumedJournal, gives_the_bytes_of_an_uninterrupted_run) {
  const auto path = log("room.log", room_log_lines());
  const fs::path whole = uninterrupted(path);
  for (const std::size_t scans : {0U, 1U, 70U, 150U}) {
    crash_after(scans, SessionInput(path));
    EXPECT_EQ(read_session_file(saved_).frames.size(), scans);
    expect_resumed(whole, path);
  }
}

TEST_F(ResumedJournal, without_a_log_it_gives_the_map_of_the_recorded_scans) {
  const auto path = log("room.log", room_log_lines());
  MappingSession part(path, settings_);
  for (int i = 0; i < 90; ++i) part.step();
  part.finish();
  const fs::path expected = export_of(part, "part");
  crash_after(90, SessionInput(path));
  fs::remove(path);
  expect_resumed(expected, {});
}

TEST_F(ResumedJournal, survives_a_crash_after_a_crash) {
  const auto path = log("room.log", room_log_lines());
  const fs::path whole = uninterrupted(path);
  crash_after(60, SessionInput(path));
  crash_after(20, resumed(path));
  EXPECT_EQ(read_session_file(saved_).frames.size(), 60U) << "scans that are mapped again are not lost";
  crash_after(110, resumed(path));
  EXPECT_EQ(read_session_file(saved_).frames.size(), 110U);
  expect_resumed(whole, path);
}

TEST_F(ResumedJournal, continues_in_a_second_log) {
  const auto lines = room_log_lines();
  const auto first = log("first.log", {lines.begin(), lines.begin() + 80});
  const auto second = log("second.log", {lines.begin() + 80, lines.end()});
  const fs::path whole = uninterrupted(log("room.log", lines));
  saved_after(80, first);
  crash_after(120, resumed(second));
  const SessionRecording recording = read_session_file(saved_);
  ASSERT_EQ(recording.facts.logs.size(), 2U);
  EXPECT_EQ(recording.facts.logs[1].scans, 40U);
  MappingSession session(resumed(second), settings_);
  session.run(go_on_);
  expect_same_results(whole, export_of(session, "resumed"));
}

TEST_F(ResumedJournal, keeps_scans_as_the_log_states_them) {
  settings_.log.sweep_time_s = 0.15;
  const auto path = log("room.log", standing_log_lines(20, 250, 30));
  for (const char* odometry : {"auto", "none"}) {
    settings_.log.odometry = odometry;
    MappingSession uninterrupted(path, settings_);
    uninterrupted.run(go_on_);
    const fs::path whole = export_of(uninterrupted, odometry);
    crash_after(290, SessionInput(path));
    const std::vector<Frame> frames = read_session_file(saved_).frames;
    EXPECT_TRUE(std::all_of(frames.begin(), frames.end(), has_ranges)) << "before ranges are discarded";
    expect_resumed(whole, path);
  }
}

TEST_F(ResumedJournal, keeps_edits_made_while_mapping) {
  const auto path = log("room.log", room_log_lines());
  MappingSession whole(path, settings_);
  {
    MappingSession crashed(path, settings_);
    crashed.start_journal(saved_);
    for (MappingSession* session : {&whole, &crashed}) {
      for (int i = 0; i < 148; ++i) session->step();
      const std::vector<LoopRecord> loops = session->mapper().loops();
      const auto loop = std::find_if(loops.begin(), loops.end(),
                                     [](const LoopRecord& any) { return any.state == LoopState::kAccepted; });
      ASSERT_NE(loop, loops.end());
      session->edit({LoopEdit::Kind::kDelete, loop->frame, loop->local_map});
    }
  }
  EXPECT_FALSE(whole.edits().empty());
  EXPECT_EQ(read_session_file(saved_).facts.edits.text(), whole.edits().text());
  whole.run(go_on_);
  expect_resumed(export_of(whole, "whole"), path);
}

TEST_F(ResumedJournal, is_continued_by_a_stream_again_and_again) {
  const auto path = log("room.log", room_log_lines(60));
  std::vector<Frame> frames;
  for (const auto source = open_log(path, log_options(settings_)); auto frame = source->next();)
    frames.push_back(*std::move(frame));
  constexpr std::size_t kPart = 20;
  for (std::size_t begin = 0; begin < frames.size(); begin += kPart) {
    const auto first = frames.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto open = [part = std::vector<Frame>(first, first + kPart)](const LogOptions&) {
      return std::make_unique<FramesInMemory>(part);
    };
    MappingSession session(
        begin == 0 ? SessionInput("robot", open)
                   : SessionInput(std::make_shared<const SessionRecording>(read_session_file(saved_)),
                                  "robot", open),
        settings_);
    session.start_journal(saved_);
    while (session.step()) {
    }
    EXPECT_THAT(session.warnings_of_logs_before(), IsEmpty()) << "a stream has no scans left";
    if (begin + kPart < frames.size()) continue;  // crashed
    session.finish();
    EXPECT_FALSE(session.result().interrupted);
    expect_same_results(uninterrupted(path), export_of(session, "resumed"));
  }
  EXPECT_EQ(read_session_file(saved_).frames.size(), frames.size());
}

TEST_F(ResumedSession, reports_damage_and_skipped_lines_again) {
  auto lines = room_log_lines(60);
  lines[20] = "FLASER 181 1.0 2.0";
  lines.resize(40);
  const auto path = log("room.log", lines);
  std::ofstream(path, std::ios::app) << "FLASER 181 1.0 2.0";
  MappingSession session(path, settings_);
  session.run(go_on_);
  session.save(saved_);
  for (const fs::path& behind : {fs::path(), path}) {
    MappingSession again(resumed(behind), settings_);
    again.run(go_on_);
    EXPECT_EQ(again.broken_off(), session.broken_off());
    EXPECT_EQ(again.run_info().warnings, session.run_info().warnings);
    EXPECT_FALSE(again.result().interrupted);
  }
}

/// Resumes a session with a second log of 30 scans. The first log is damaged at its end, or its mapping was
/// interrupted.
class ContinuedWithAnotherLog : public ResumedSession {
 protected:
  void expect_told_again_and_again(const std::string& what, bool interrupted) {
    const auto lines = room_log_lines(90);
    const auto second = log("second.log", {lines.begin() + 60, lines.end()});
    // Resumes with another log, without a log, and with the last log of the session.
    for (const fs::path& behind : {second, fs::path(), second}) {
      MappingSession session(resumed(behind), settings_);
      session.run(go_on_);
      EXPECT_FALSE(session.broken_off()) << "the second log is not damaged";
      EXPECT_EQ(session.breaks_off(), !interrupted);
      EXPECT_EQ(session.result().interrupted, interrupted);
      EXPECT_THAT(session.warnings_of_logs_before(), ElementsAre(HasSubstr(what)));
      EXPECT_THAT(session.run_info().warnings, testing::Contains(HasSubstr(what)));
      EXPECT_EQ(session.skipped_lines().count, 1U);
      EXPECT_THAT(session.skipped_lines().first, HasSubstr("first.log:21"));
      session.save(saved_);
    }
  }

  /// Returns the lines of a log with one malformed line.
  std::vector<std::string> lines_of_first() const {
    auto lines = room_log_lines(50);
    lines[20] = "FLASER 181 1.0 2.0";
    return lines;
  }
};

TEST_F(ContinuedWithAnotherLog, warns_of_a_damaged_log) {
  const auto path = log("first.log", lines_of_first());
  std::ofstream(path, std::ios::app) << "FLASER 181 1.0 2.0";
  MappingSession session(path, settings_);
  session.run(go_on_);
  ASSERT_TRUE(session.broken_off());
  session.save(saved_);
  expect_told_again_and_again("first.log:51", false);
}

TEST_F(ContinuedWithAnotherLog, warns_of_an_interrupted_log) {
  saved_after(40, log("first.log", lines_of_first()));
  expect_told_again_and_again("only the first 40 scans of first.log are mapped", true);
}

/// A log with odometry that measures 10 % too much.
class CalibratedSession : public ResumedSession {
 protected:
  CalibratedSession() {
    settings_.log.calibrate = true;
    SimulatedRun run = round_trips(1);
    for (mrpt::math::TPose2D& pose : run.odometry) {
      pose.x *= 1.1;
      pose.y *= 1.1;
    }
    std::istringstream text(carmen_log(run));
    for (std::string line; std::getline(text, line);) lines_.push_back(line);
  }

  /// Returns how often the observer of the calibration was called.
  int steps_of_calibration(SessionInput& input) const {
    int steps = 0;
    input.calibrate(log_options(settings_), [&](double) { ++steps; });
    return steps;
  }

  static double scale_of(const RunInfo& info) {
    for (const CalibratedOption& estimate : info.calibration)
      if (estimate.option == "log.odometry_scale" && estimate.is_used) return estimate.value;
    return 0;
  }

  std::vector<std::string> lines_;
};

TEST_F(CalibratedSession, is_resumed_without_another_calibration_and_gives_the_same_bytes) {
  const auto path = log("room.log", lines_);
  SessionInput input(path);
  EXPECT_GT(steps_of_calibration(input), 100);
  EXPECT_EQ(steps_of_calibration(input), 0) << "of a calibrated input";
  MappingSession plain(input, settings_);
  plain.run(go_on_);
  const fs::path whole = export_of(plain, "uninterrupted");
  EXPECT_NEAR(scale_of(plain.run_info()), 1 / 1.1, 0.01);
  saved_after(60, path);
  SessionInput rest = resumed(path);
  EXPECT_EQ(steps_of_calibration(rest), 0);
  MappingSession session(rest, settings_);
  session.run(go_on_);
  EXPECT_EQ(session.result().frames.size(), lines_.size() - 1);
  expect_same_results(whole, export_of(session, "resumed"));
  EXPECT_EQ(session.run_info().warnings, plain.run_info().warnings);
  EXPECT_EQ(scale_of(session.run_info()), scale_of(plain.run_info()));
}

TEST_F(CalibratedSession, keeps_its_estimates_for_a_log_that_continues_it) {
  const auto half = lines_.begin() + 200;
  saved_after(200, log("first.log", {lines_.begin(), half}));
  const double scale = read_session_file(saved_).facts.logs.back().calibration->estimates.front().value;
  SessionInput input = resumed(log("second.log", {half, lines_.end()}));
  EXPECT_EQ(steps_of_calibration(input), 0);
  EXPECT_EQ(input.logs().back().calibration->estimates.front().value, scale);
  EXPECT_EQ(input.logs().back().calibration->estimates.front().log, "second.log");
  EXPECT_THAT(input.logs().back().calibration->sentences,
              ElementsAre("log.calibrate keeps the estimates of first.log"));
}

TEST_F(CalibratedSession, keeps_no_estimates_that_do_not_suit_the_lasers_of_the_next_log) {
  const auto half = lines_.begin() + 200;
  saved_after(200, log("first.log", {lines_.begin(), half}));
  SessionRecording recording = read_session_file(saved_);
  const auto second = log("second.log", {half, lines_.end()});
  std::vector<CalibratedOption>& estimates = recording.facts.logs.back().calibration->estimates;
  const auto input_after = [&](std::vector<CalibratedOption> estimated) {
    estimates = std::move(estimated);
    return SessionInput(std::make_shared<const SessionRecording>(recording), second);
  };
  const std::vector<CalibratedOption> mount{{"", "", "log.laser_x_m", 0.2, 0.001, true},
                                            {"", "", "log.laser_y_m", 0, 0.001, true},
                                            {"", "", "log.laser_yaw_deg", 0, 0.1, true}};
  for (const bool calibrates : {true, false}) {  // wrong statements are replaced without log.calibrate, too
    std::vector<CalibratedOption> known = mount;
    for (CalibratedOption& estimate : known) estimate.is_fault = !calibrates;
    settings_.log.calibrate = calibrates;
    for (const char* lasers : {"", "all"}) {
      const bool all = lasers == std::string("all");
      settings_.log.laser = lasers;
      SessionInput input = input_after(known);
      for (int twice = 0; twice < 2; ++twice) input.calibrate(log_options(settings_));
      const LogCalibration& kept = *input.logs().back().calibration;
      EXPECT_EQ(kept.estimates.front().is_used, !all);
      EXPECT_EQ(kept.sentences.size(), all ? 2U : 1U);
    }
  }
  settings_.log.calibrate = true;
  settings_.log.laser.clear();
  SessionInput input = input_after({{"", "LEFT", "log.scan_delay_s", 0.2, 0.001, true}});
  EXPECT_THAT(
      sentence_of([&] { input.calibrate(log_options(settings_)); }),
      testing::AllOf(testing::HasSubstr("second.log keeps the calibration of first.log, but has other "
                                        "lasers: log.scan_delay_s"),
                     testing::HasSubstr("combine both with psi-slam merge")));
}

TEST_F(CalibratedSession, can_be_interrupted_while_it_calibrates) {
  SessionInput input(log("room.log", lines_));
  double last = 0;
  EXPECT_THROW(input.calibrate(log_options(settings_),
                               [&](double share) {
                                 EXPECT_GE(share, last);
                                 last = share;
                                 if (share > 0.4) throw SystemFailure("interrupted");
                               }),
               SystemFailure);
  EXPECT_LT(last, 0.5);
  EXPECT_FALSE(input.logs().back().calibration);
}

TEST_F(CalibratedSession, can_be_interrupted_while_it_looks_for_wrong_statements) {
  settings_.log.calibrate = false;
  SessionInput input(log("room.log", lines_));
  const auto interrupt = [](double share) {
    EXPECT_EQ(share, 0);
    throw SystemFailure("interrupted");
  };
  EXPECT_THROW(input.calibrate(log_options(settings_), interrupt), SystemFailure);
  input.calibrate(log_options(settings_), interrupt);  // looks once only
  EXPECT_FALSE(input.logs().back().calibration);
}

TEST_F(CalibratedSession, keeps_what_the_reader_of_an_earlier_log_left_out) {
  settings_.log.calibrate = false;
  const auto half = lines_.begin() + 200;
  const auto begin_of_poses = [](const std::string& line) {  // after 180 readings
    std::size_t at = 0;
    for (int words = 0; words < 182; ++words) at = line.find(' ', at) + 1;
    return at;
  };
  std::string& stalled = lines_[150];
  stalled = lines_[149].substr(0, begin_of_poses(lines_[149])) + stalled.substr(begin_of_poses(stalled));
  saved_after(199, log("first.log", {lines_.begin(), half}));
  MappingSession session(resumed(log("second.log", {half, lines_.end()})), settings_);
  session.run(go_on_);
  EXPECT_THAT(session.run_info().warnings,
              testing::Contains(HasSubstr("first.log: 1 scan repeats the readings of an earlier scan")));
  EXPECT_EQ(session.result().frames.size(), lines_.size() - 2);
}

TEST_F(ResumedSession, rejects_a_log_that_does_not_continue_it) {
  const auto path = log("room.log", room_log_lines(60));
  saved_after(40, path);
  const auto other = log("other.log", room_log_lines(50, 90));
  EXPECT_THAT(sentence_of([&] { MappingSession(resumed(other), settings_); }),
              HasSubstr("other.log is not the log of the session"));
  EXPECT_THAT(sentence_of([&] { resumed(folder_.path() / "none.log"); }), HasSubstr("does not exist"));
}

TEST_F(ResumedSession, restores_settings_and_keeps_those_that_shape_the_map) {
  BoundSettings recorded;
  recorded.load(
      {}, {"front_end.node_rotation_deg=7.3", "log.max_range_m=40", "map.resolution_m=0.1", "run.seed=5"});
  SessionFacts facts;
  facts.settings = settings_file_text(recorded.settings);
  BoundSettings bound;
  EXPECT_THAT(load_recorded(bound, facts, "my.session"), IsEmpty());
  EXPECT_EQ(kept_settings(bound.table), kept_settings(recorded.table));
  EXPECT_EQ(bound.settings.mapper.front_end.node_rotation_rad,
            recorded.settings.mapper.front_end.node_rotation_rad);
  EXPECT_EQ(bound.settings.map.resolution_m, 0.1);

  const auto kept = kept_settings(bound.table);
  bound.load({}, {"map.write_png=false", "run.threads=3", "front_end.node_rotation_deg=7.3"});
  EXPECT_NO_THROW(require_kept(kept, bound.table, "my.session"));
  bound.load({}, {"front_end.node_rotation_deg=8"});
  EXPECT_THAT(sentence_of([&] { require_kept(kept, bound.table, "my.session"); }),
              HasSubstr("front_end.node_rotation_deg is 7.3 in the session my.session and cannot become 8"));
}

TEST_F(ResumedSession, ignores_obsolete_options_with_a_warning) {
  SessionFacts facts;
  facts.settings = "[front_end]\nwindow_m = 0.2\nnode_distance_m = 0.2\nmagic = 3\n[gone]\nkey = 1\n";
  BoundSettings bound;
  EXPECT_THAT(load_recorded(bound, facts, "old.session"),
              ElementsAre("old.session: ignores obsolete options: front_end.magic, gone.key"));
  EXPECT_EQ(bound.settings.mapper.front_end.node_distance_m, 0.2);
  EXPECT_EQ(bound.settings.mapper.front_end.window_m, 0.2) << "constants of the recorded run are restored";
  facts.settings = "[log]\nodometry_topic = /odom\n[last_pass]\npasses = 1\n";
  EXPECT_THAT(load_recorded(bound, facts, "old.session"), IsEmpty());
  EXPECT_EQ(bound.settings.mapper.back_end.final_search.passes, 1);
  EXPECT_EQ(bound.table.option("log.odometry", "").text(), "/odom");
  facts.settings = "[front_end]\nnode_distance_m = -1\n";
  EXPECT_THAT(sentence_of([&] { load_recorded(bound, facts, "old.session"); }),
              HasSubstr("old.session:2: front_end.node_distance_m"));
}

TEST_F(ResumedSession, warns_of_another_version_of_the_program) {
  saved_after(10, log("room.log", room_log_lines(10)));
  SessionFacts facts = read_session_file(saved_).facts;
  EXPECT_FALSE(other_version_text("now.session", facts).has_value());
  facts.program_version = "0.0.7";
  EXPECT_THAT(other_version_text("old.session", facts).value(),
              HasSubstr("old.session was made by psi-slam 0.0.7. This is "));
}

}  // namespace
}  // namespace psi_slam
