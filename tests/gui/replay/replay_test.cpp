// SPDX-License-Identifier: BSD-3-Clause
#include "gui/replay.h"

#include <gmock/gmock.h>

#include <functional>
#include <memory>
#include <set>
#include <thread>

#include "../../session/room_log.h"
#include "awaited_snapshot.h"
#include "map/report/output_folder.h"
#include "psi_slam/mapping_session.h"
#include "same_results.h"
#include "session/edit_journal.h"
#include "session/session_file.h"
#include "session/settings.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class ReplayTest : public testing::Test {
 protected:
  std::filesystem::path log(const std::vector<std::string>& lines) {
    return write_lines(folder_.path() / "room.log", lines);
  }
  std::filesystem::path out(const std::string& name) const { return folder_.path() / name; }

  /// Maps the log as psi-slam does, without a window, and writes the results.
  void map_headless(const std::filesystem::path& log, const std::string& name) {
    MappingSession session(log, settings_);
    session.run(std::atomic<bool>(false));
    session.export_to(OutputFolder::prepare(out(name), false));
  }

  TemporaryFolder folder_;
  Settings settings_;
};

TEST_F(ReplayTest, opens_the_log_and_waits) {
  const Replay replay(log(room_log_lines(20)), settings_);
  const SnapshotPtr snapshot = wait_for(replay, ReplayPhase::kPaused);
  EXPECT_EQ(snapshot->frames.size(), 0U);
  EXPECT_TRUE(snapshot->failure.empty());
}

TEST_F(ReplayTest, steps_one_scan_at_a_time) {
  Replay replay(log(room_log_lines(20)), settings_);
  for (std::size_t scans = 1; scans <= 3; ++scans) {
    replay.step();
    const SnapshotPtr snapshot = wait_for(replay, [&](const ReplaySnapshot& now) {
      return now.phase == ReplayPhase::kPaused && now.frames.size() == scans;
    });
    EXPECT_EQ(snapshot->log.size(), scans);
    EXPECT_EQ(snapshot->shares.size(), scans);
    EXPECT_EQ(snapshot->log.back().index, scans - 1);
    EXPECT_EQ(snapshot->progress.scans, scans);
  }
}

TEST_F(ReplayTest, playing_and_pausing_gives_the_results_of_psi_slam) {
  const auto path = log(room_log_lines());
  map_headless(path, "headless");
  Replay replay(path, settings_);
  replay.set_speed(10);  // slow enough to pause before the end of the log
  replay.play();
  wait_for(replay, [](const ReplaySnapshot& now) { return now.frames.size() > 20; });
  replay.pause();
  wait_for(replay, ReplayPhase::kPaused);
  replay.step();
  replay.step();
  replay.hurry_to(90);
  const SnapshotPtr hurried = wait_for(replay, [](const ReplaySnapshot& now) {
    return now.phase == ReplayPhase::kPaused && now.frames.size() >= 90;
  });
  EXPECT_EQ(hurried->frames.size(), 90U) << "the replay stops at the requested scan";
  while (replay.stamps_us() == nullptr) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(replay.stamps_us()->size(), 150U);
  replay.set_speed(0);
  replay.play();
  const SnapshotPtr finished = wait_for(replay, ReplayPhase::kFinished);
  EXPECT_EQ(finished->frames.size(), 150U);
  EXPECT_FALSE(finished->interrupted);
  EXPECT_FALSE(finished->loops->empty());
  replay.export_to(out("played"), false);
  EXPECT_EQ(wait_for_export(replay, 1)->exported->failure, "");
  expect_same_results(out("headless"), out("played"));
  replay.export_to(out("again"), false);
  EXPECT_EQ(wait_for_export(replay, 2)->exported->failure, "");
  expect_same_results(out("headless"), out("again"));
}

TEST_F(ReplayTest, a_saved_and_resumed_session_gives_the_results_of_psi_slam) {
  const auto path = log(room_log_lines());
  map_headless(path, "headless");
  {
    Replay replay(path, settings_);
    replay.hurry_to(70);
    wait_for(replay, [](const ReplaySnapshot& now) {
      return now.phase == ReplayPhase::kPaused && now.frames.size() >= 70;
    });
    replay.save_session(out("my.session"));
    EXPECT_EQ(wait_for_save(replay, 1)->saved->path, out("my.session"));
    replay.save_session(out("missing") / "my.session");
    const SnapshotPtr failed =
        wait_for(replay, [](const ReplaySnapshot& now) { return now.saved && now.saved->number == 2; });
    EXPECT_THAT(failed->saved->failure, HasSubstr("cannot write"));
    EXPECT_EQ(failed->phase, ReplayPhase::kPaused);
  }
  const auto recording = std::make_shared<const SessionRecording>(read_session_file(out("my.session")));
  EXPECT_EQ(recording->frames.size(), 70U);
  Replay replay(SessionInput(recording, path), settings_);
  while (replay.stamps_us() == nullptr) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(replay.stamps_us()->size(), 150U);
  replay.set_speed(0);
  replay.play();
  const LoopRecord loop = wait_for(replay, ReplayPhase::kFinished)->loops->front();
  replay.export_to(out("resumed"), false);
  EXPECT_EQ(wait_for_export(replay, 1)->exported->failure, "");
  expect_same_results(out("headless"), out("resumed"));

  replay.edit({LoopEdit::Kind::kDelete, loop.frame, loop.local_map});
  wait_for(replay,
           [](const ReplaySnapshot& now) { return now.edited && now.phase == ReplayPhase::kFinished; });
  replay.save_session(out("edited.session"));
  wait_for_save(replay, 1);
  const SessionRecording edited = read_session_file(out("edited.session"));
  EXPECT_EQ(edited.frames.size(), 150U);
  EXPECT_EQ(edited.facts.edits.edits().size(), 1U);
}

TEST_F(ReplayTest, plays_at_a_multiple_of_the_recorded_speed) {
  Replay replay(log(room_log_lines(6)), settings_);  // the log has five scans a second
  replay.set_speed(20);
  const auto start = std::chrono::steady_clock::now();
  replay.play();
  wait_for(replay, ReplayPhase::kFinished);
  EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(4 * 200 / 20));
}

TEST_F(ReplayTest, snapshots_are_consistent) {
  Replay replay(log(room_log_lines()), settings_);
  replay.set_speed(0);
  replay.play();
  std::size_t scans = 0;
  while (true) {
    const SnapshotPtr now = replay.snapshot();
    EXPECT_GE(now->frames.size(), scans);
    scans = now->frames.size();
    EXPECT_EQ(now->log.size(), scans);
    EXPECT_EQ(now->nodes.size(), now->map_T_node->size());
    for (std::size_t i = 0; i < now->nodes.size(); ++i) EXPECT_LT(now->nodes[i].frame, scans);
    for (std::size_t i = 0; i < now->local_maps.size(); ++i)
      EXPECT_LT(now->local_maps[i].last_node, now->nodes.size());
    for (const LoopRecord& loop : *now->loops) EXPECT_LT(loop.local_map, now->local_maps.size());
    for (const ActiveLocalMap& active : now->active_local_maps)
      EXPECT_GT(active.occupancy->getSizeX(), 1U) << "the local map is not packed";
    if (now->phase == ReplayPhase::kFinished) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(scans, 150U);
  EXPECT_GT(replay.snapshot()->local_maps.size(), 1U);
  EXPECT_EQ(replay.snapshot()->local_maps.back().last_node, replay.snapshot()->nodes.size() - 1);
  EXPECT_TRUE(replay.snapshot()->active_local_maps.empty());
}

TEST_F(ReplayTest, draws_the_map_as_it_goes) {
  Replay replay(log(room_log_lines()), settings_);
  EXPECT_EQ(replay.drawn_map(), nullptr);
  replay.set_speed(0);
  replay.play();
  wait_for(replay, ReplayPhase::kFinished);
  while (replay.drawn_map() == nullptr || replay.drawn_map()->scans < 150)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  const std::shared_ptr<const DrawnMap> map = replay.drawn_map();
  const int longer_px = std::max(map->raster.width_px, map->raster.height_px);
  EXPECT_NEAR(longer_px * map->raster.resolution_m, 12 + 2 * 0.5, 0.5) << "the room is 12 m long";
  EXPECT_EQ(map->raster.pixels.size(),
            4U * static_cast<std::size_t>(map->raster.width_px * map->raster.height_px));
}

TEST_F(ReplayTest, finishing_early_keeps_the_scans_mapped_so_far) {
  Replay replay(log(room_log_lines()), settings_);
  for (int i = 0; i < 30; ++i) replay.step();
  wait_for(replay, [](const ReplaySnapshot& now) { return now.frames.size() == 30; });
  replay.finish();
  const SnapshotPtr finished = wait_for(replay, ReplayPhase::kFinished);
  EXPECT_EQ(finished->frames.size(), 30U);
  EXPECT_TRUE(finished->interrupted);
}

TEST_F(ReplayTest, a_truncated_log_is_mapped_up_to_its_end_with_a_warning) {
  const auto path = log(room_log_lines(40));
  std::ofstream(path, std::ios::app) << "FLASER 181 1.0 2.0";
  Replay replay(path, settings_);
  replay.set_speed(0);
  replay.play();
  const SnapshotPtr finished = wait_for(replay, ReplayPhase::kFinished);
  EXPECT_EQ(finished->frames.size(), 40U);
  EXPECT_THAT(finished->warnings, ElementsAre(HasSubstr("room.log:41")));
}

TEST_F(ReplayTest, reports_why_a_log_cannot_be_mapped) {
  Replay missing(folder_.path() / "missing.log", settings_);
  EXPECT_THAT(wait_for(missing, ReplayPhase::kFailed)->failure, HasSubstr("missing.log does not exist"));
  Replay corrupt(log({"FLASER 181 1.0 2.0", "FLASER 181 1.0"}), settings_);
  corrupt.play();
  EXPECT_THAT(wait_for(corrupt, ReplayPhase::kFailed)->failure, HasSubstr("room.log:1:"));
  settings_.mapper.back_end.psi.psi_1 = 50;
  const Replay contradicting(log(room_log_lines(5)), settings_);
  EXPECT_THAT(wait_for(contradicting, ReplayPhase::kFailed)->failure, HasSubstr("psi.psi_1"));
}

TEST_F(ReplayTest, writes_to_a_folder_that_is_not_empty_only_on_request) {
  write_file(folder_.path() / "notes.txt", "mine");
  Replay replay(log(room_log_lines(20)), settings_);
  replay.export_to(folder_.path(), false);  // the request waits until the map is finished
  replay.set_speed(0);
  replay.play();
  EXPECT_THAT(wait_for_export(replay, 1)->exported->failure, HasSubstr(folder_.path().string()));
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "map.png"));
  replay.export_to(folder_.path(), true);
  EXPECT_EQ(wait_for_export(replay, 2)->exported->failure, "");
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "map.png"));
}

TEST_F(ReplayTest, a_log_deleted_while_it_is_open_is_mapped_with_a_remark) {
  const auto path = log(room_log_lines());
  Replay replay(path, settings_);
  replay.step();
  wait_for(replay, [](const ReplaySnapshot& now) { return now.frames.size() == 1; });
  std::filesystem::remove(path);
  replay.set_speed(0);
  replay.play();
  EXPECT_EQ(wait_for(replay, ReplayPhase::kFinished)->frames.size(), 150U);
  replay.save_session(out("rescued.session"));
  EXPECT_THAT(wait_for_save(replay, 1)->saved->remark, HasSubstr("room.log is no longer readable or became"));
  const SessionRecording rescued = read_session_file(out("rescued.session"));
  EXPECT_EQ(rescued.frames.size(), 150U);
  EXPECT_EQ(rescued.facts.logs[0].sha256, "");
}

TEST_F(ReplayTest, closing_refuses_pending_requests_with_a_reason) {
  Replay replay(log(room_log_lines(60)), settings_);
  wait_for(replay, ReplayPhase::kPaused);
  replay.export_to(out("never"), false);  // the request waits until the map is finished
  replay.close();
  while (!replay.ended()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  ASSERT_TRUE(replay.snapshot()->exported.has_value());
  EXPECT_THAT(replay.snapshot()->exported->failure, HasSubstr("never was not written"));
  EXPECT_FALSE(std::filesystem::exists(out("never")));
}

TEST_F(ReplayTest, a_session_saved_half_way_through_mapping_it_again_keeps_all_scans) {
  {
    MappingSession session(log(room_log_lines(40)), settings_);
    session.run(std::atomic<bool>(false));
    session.save(out("whole.session"));
  }
  Replay replay(SessionInput::of_file(out("whole.session")), settings_);
  replay.hurry_to(10);
  wait_for(replay, [](const ReplaySnapshot& now) {
    return now.phase == ReplayPhase::kPaused && now.frames.size() == 10;
  });
  replay.save_session(out("again.session"));
  EXPECT_EQ(wait_for_save(replay, 1)->saved->written.scans, 40U);
  EXPECT_EQ(read_session_file(out("again.session")).frames.size(), 40U);
}

TEST_F(ReplayTest, can_be_closed_at_any_moment) {
  const auto path = log(room_log_lines());
  for (const std::size_t scans : {0U, 1U, 70U, 149U}) {
    Replay replay(path, settings_);
    replay.set_speed(0);
    if (scans > 0) replay.play();
    wait_for(replay, [&](const ReplaySnapshot& now) { return now.frames.size() >= scans; });
  }
  Replay final_search(path, settings_);
  final_search.set_speed(0);
  final_search.play();
  wait_for(final_search, [](const ReplaySnapshot& now) { return now.phase >= ReplayPhase::kFinalSearch; });
  final_search.close();
  while (!final_search.ended()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

class HeldFinalSearch : public ReplayTest {
 protected:
  /// Returns a replay that is paused in its final loop search.
  std::unique_ptr<Replay> held() {
    auto replay = std::make_unique<Replay>(log(room_log_lines()), settings_);
    replay->set_speed(0);
    replay->play();
    wait_for(*replay, [](const ReplaySnapshot& now) { return now.phase >= ReplayPhase::kFinalSearch; });
    replay->pause();
    wait_for(*replay, [](const ReplaySnapshot& now) { return now.final_search_held; });
    return replay;
  }
};

TEST_F(HeldFinalSearch, waits_and_then_gives_the_same_results) {
  const auto replay = held();
  const SnapshotPtr held = replay->snapshot();
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_EQ(replay->snapshot()->phase, ReplayPhase::kFinalSearch);
  EXPECT_EQ(replay->snapshot()->progress.share, held->progress.share) << "the paused search does not advance";
  replay->play();
  EXPECT_FALSE(wait_for(*replay, ReplayPhase::kFinished)->final_search_held);
  EXPECT_FALSE(replay->snapshot()->interrupted);
  map_headless(folder_.path() / "room.log", "headless");
  replay->export_to(out("held"), false);
  EXPECT_EQ(wait_for_export(*replay, 1)->exported->failure, "");
  expect_same_results(out("headless"), out("held"));
}

TEST_F(ReplayTest, the_search_of_a_prior_map_can_be_paused_and_its_folder_is_kept) {
  const auto path = log(room_log_lines(60, 50));
  map_headless(path, "prior");
  settings_.prior.map = (out("prior") / "map.yaml").string();
  map_headless(path, "headless");
  Replay replay(path, settings_);
  replay.set_speed(0);
  replay.play();
  wait_for(replay, [](const ReplaySnapshot& now) { return now.phase >= ReplayPhase::kFinalSearch; });
  replay.pause();
  wait_for(replay, [](const ReplaySnapshot& now) { return now.final_search_held; });
  replay.play();
  wait_for(replay, ReplayPhase::kFinished);
  replay.export_to(out("prior"), true);
  EXPECT_THAT(wait_for_export(replay, 1)->exported->failure,
              HasSubstr("Choose another folder for the results"));
  replay.export_to(out("held"), false);
  EXPECT_EQ(wait_for_export(replay, 2)->exported->failure, "");
  expect_same_results(out("headless"), out("held"));
}

TEST_F(HeldFinalSearch, can_be_cut_at_once) {
  const auto replay = held();
  replay->cut_final_search();
  EXPECT_TRUE(wait_for(*replay, ReplayPhase::kFinished)->interrupted);
}

TEST_F(HeldFinalSearch, can_be_closed_at_once) {
  const auto replay = held();
  replay->close();
  while (!replay->ended()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

TEST_F(ReplayTest, finish_after_a_pause_does_not_wait_in_the_final_search) {
  Replay replay(log(room_log_lines()), settings_);
  for (int i = 0; i < 30; ++i) replay.step();
  wait_for(replay, [](const ReplaySnapshot& now) { return now.frames.size() == 30; });
  replay.pause();
  replay.finish();
  EXPECT_EQ(wait_for(replay, ReplayPhase::kFinished)->frames.size(), 30U);
}

TEST_F(ReplayTest, an_export_in_progress_is_completed_before_closing) {
  {
    Replay replay(log(room_log_lines(30)), settings_);
    replay.set_speed(0);
    replay.play();
    replay.export_to(out("whole"), false);
    wait_for(replay, [](const ReplaySnapshot& now) {
      return now.phase == ReplayPhase::kExporting || now.exported.has_value();
    });
  }
  EXPECT_TRUE(std::filesystem::exists(out("whole") / "report.html")) << "the last file of an export";
}

class ReplayEditsTest : public ReplayTest {
 protected:
  static SnapshotPtr wait_for_edit(const Replay& replay, int number) {
    return wait_for(replay, [number](const ReplaySnapshot& snapshot) {
      return snapshot.edited && snapshot.edited->number == number;
    });
  }
  static SnapshotPtr wait_until_finished_after_edit(const Replay& replay, int number) {
    return wait_for(replay, [number](const ReplaySnapshot& snapshot) {
      return snapshot.edited && snapshot.edited->number == number && snapshot.phase == ReplayPhase::kFinished;
    });
  }

  static LoopEdit delete_first_accepted(const ReplaySnapshot& snapshot) {
    for (const LoopRecord& loop : *snapshot.loops)
      if (loop.state == LoopState::kAccepted) return {LoopEdit::Kind::kDelete, loop.frame, loop.local_map};
    throw std::logic_error("no loop was closed");
  }
  /// Returns the state of a loop, or the reason why it was rejected.
  static std::string state_of(const ReplaySnapshot& snapshot, const LoopEdit& edit) {
    for (const LoopRecord& loop : *snapshot.loops)
      if (loop.frame == edit.frame && loop.local_map == edit.local_map)
        return loop.rejection ? text_of(loop.rejection) : state_text(loop.state);
    throw std::logic_error("the two were never matched");
  }
  /// Exports the replay, and expects the same files of a run of the log with the exported edits.
  void expect_repeated_without_window(Replay& replay, const std::filesystem::path& log) {
    replay.export_to(out("window"), false);
    EXPECT_EQ(wait_for_export(replay, 1)->exported->failure, "");

    MappingSession session(log, settings_);
    session.add_edits(EditJournal::read(out("window") / "loops.edits"));
    session.run(std::atomic<bool>(false));
    session.export_to(OutputFolder::prepare(out("headless"), false));
    expect_same_results(out("window"), out("headless"));
  }
};

TEST_F(ReplayEditsTest, are_shown_at_once_and_can_be_undone_and_redone) {
  Replay replay(log(room_log_lines(150)), settings_);
  replay.hurry_to(140);
  const SnapshotPtr mapped = wait_for(replay, [](const ReplaySnapshot& now) {
    return now.phase == ReplayPhase::kPaused && now.frames.size() == 140;
  });
  const LoopEdit edit = delete_first_accepted(*mapped);
  replay.edit(edit);
  const SnapshotPtr edited = wait_for_edit(replay, 1);
  EXPECT_EQ(state_of(*edited, edit), "deleted by hand");
  EXPECT_NE(edited->map_T_node->back(), mapped->map_T_node->back());
  EXPECT_EQ(edited->edits->size(), 1U);
  EXPECT_THAT(edited->undo_text, HasSubstr("delete the loop of scan"));
  EXPECT_EQ(edited->redo_text, "");
  replay.undo();
  const SnapshotPtr undone = wait_for_edit(replay, 2);
  EXPECT_EQ(state_of(*undone, edit), "accepted");
  EXPECT_EQ(undone->undo_text, "");
  EXPECT_THAT(undone->redo_text, HasSubstr("delete the loop of scan"));
  replay.undo();  // nothing is left to undo
  replay.redo();
  EXPECT_EQ(state_of(*wait_for_edit(replay, 3), edit), "deleted by hand");
  replay.set_speed(0);
  replay.play();
  EXPECT_EQ(state_of(*wait_for(replay, ReplayPhase::kFinished), edit), "deleted by hand")
      << "the edit survives later scans";
}

TEST_F(ReplayEditsTest, give_the_same_results_as_psi_slam_with_their_file) {
  const auto path = log(room_log_lines(200));
  Replay replay(path, settings_);
  replay.hurry_to(150);
  const SnapshotPtr mapped = wait_for(replay, [](const ReplaySnapshot& now) {
    return now.phase == ReplayPhase::kPaused && now.frames.size() == 150;
  });
  replay.edit(delete_first_accepted(*mapped));
  wait_for_edit(replay, 1);
  replay.set_speed(0);
  replay.play();
  wait_for(replay, ReplayPhase::kFinalSearch);
  const LoopEdit during = delete_first_accepted(*replay.snapshot());
  replay.edit(during);
  const SnapshotPtr finished = wait_until_finished_after_edit(replay, 2);
  EXPECT_FALSE(finished->interrupted) << "the final loop search was repeated, not cut";
  LoopEdit again = delete_first_accepted(*finished);
  again.kind = LoopEdit::Kind::kMatch;
  again.matcher = MatcherKind::kCsm;
  replay.edit(again);
  replay.undo();
  replay.redo();
  wait_until_finished_after_edit(replay, 5);
  expect_repeated_without_window(replay, path);
}

TEST_F(ReplayEditsTest, of_one_run_are_repeated_in_the_next) {
  const auto path = log(room_log_lines(150));
  EditJournal journal;
  {
    Replay replay(path, settings_);
    replay.set_speed(0);
    replay.play();
    const LoopEdit edit = delete_first_accepted(*wait_for(replay, ReplayPhase::kFinished));
    replay.edit(edit);
    journal = *wait_until_finished_after_edit(replay, 1)->edits;
  }
  ASSERT_EQ(journal.edits().size(), 1U);
  Replay replay(path, settings_, journal);
  EXPECT_EQ(replay.snapshot()->edits->size(), 1U) << "the edit is known before the log opens";
  replay.set_speed(0);
  replay.play();
  const SnapshotPtr finished = wait_for(replay, ReplayPhase::kFinished);
  LoopEdit edit = journal.edits()[0].edit;
  EXPECT_EQ(state_of(*finished, edit), "deleted by hand");
  edit.kind = LoopEdit::Kind::kForce;
  replay.edit(edit);
  EXPECT_EQ(state_of(*wait_until_finished_after_edit(replay, 1), edit), "accepted");
  replay.undo();
  EXPECT_EQ(state_of(*wait_until_finished_after_edit(replay, 2), edit), "deleted by hand")
      << "the journal's edit is in force again";
}

TEST_F(ReplayEditsTest, undoing_restores_edits_planned_for_later) {
  const auto path = log(room_log_lines(150));
  LoopEdit edit;
  {
    Replay replay(path, settings_);
    replay.hurry_to(140);
    edit = delete_first_accepted(*wait_for(replay, [](const ReplaySnapshot& now) {
      return now.phase == ReplayPhase::kPaused && now.frames.size() == 140;
    }));
  }
  EditJournal journal;
  journal.add({edit, {EditTime::Kind::kEnd, 0}});
  Replay replay(path, settings_, journal);
  replay.hurry_to(140);
  wait_for(replay, [](const ReplaySnapshot& now) {
    return now.phase == ReplayPhase::kPaused && now.frames.size() == 140;
  });
  LoopEdit other = edit;
  other.kind = LoopEdit::Kind::kForce;
  replay.edit(other);
  EXPECT_EQ(wait_for_edit(replay, 1)->edits->size(), 1U) << "the planned edit is dropped";
  replay.undo();
  wait_for_edit(replay, 2);
  EXPECT_EQ(replay.edits_asked(), replay.snapshot()->edits_served);
  replay.set_speed(0);
  replay.play();
  EXPECT_EQ(state_of(*wait_for(replay, ReplayPhase::kFinished), edit), "deleted by hand");
}

TEST_F(ReplayEditsTest, that_were_not_made_are_reported) {
  EditJournal journal;
  journal.add({{LoopEdit::Kind::kDelete, 5000, 0}, {}});
  Replay replay(log(room_log_lines(60)), settings_, journal);
  replay.set_speed(0);
  replay.play();
  EXPECT_THAT(wait_for(replay, ReplayPhase::kFinished)->warnings,
              testing::ElementsAre(HasSubstr("an edit was not made: delete the loop of scan 5000")));
}

MapEdit drawn(MapEdit::Kind kind, std::vector<mrpt::math::TPoint2D> points) {
  MapEdit edit{kind, std::move(points)};
  edit.frame_T_robot = mrpt::math::TPose2D(0, 0, 0);
  return edit;
}

/// Waits until the drawn map has edits of `zones` kinds of zones.
std::shared_ptr<const DrawnMap> wait_for_zones(const Replay& replay, std::size_t zones) {
  for (int i = 0; i < 600; ++i) {
    const auto map = replay.drawn_map();
    if (map && map->zones.size() == zones) return map;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  ADD_FAILURE() << "the drawn map never has " << zones << " kinds of zones";
  return replay.drawn_map();
}

TEST_F(ReplayEditsTest, of_the_map_are_shown_undone_and_exported_like_psi_slam_does) {
  settings_.map_frame.align = "30";  // the edits stay in the frame of the window
  const auto path = log(room_log_lines(150));
  Replay replay(path, settings_);
  replay.hurry_to(100);
  wait_for(replay, [](const ReplaySnapshot& now) {
    return now.phase == ReplayPhase::kPaused && now.frames.size() == 100;
  });
  replay.edit(drawn(MapEdit::Kind::kKeepOut, {{-1, 0}, {-0.5, 0}, {-0.5, 0.5}}));
  EXPECT_EQ(wait_for_edit(replay, 1)->undo_text, "add keep-out zone");
  wait_for_zones(replay, 1);
  replay.undo();
  const SnapshotPtr undone = wait_for_edit(replay, 2);
  EXPECT_TRUE(undone->edited->undone);
  EXPECT_TRUE(undone->edits->empty());
  wait_for_zones(replay, 0);
  replay.redo();
  wait_for_edit(replay, 3);
  replay.set_speed(0);
  replay.play();
  wait_for(replay, ReplayPhase::kFinalSearch);
  replay.edit(drawn(MapEdit::Kind::kCrop, {{-3, -2}, {1, -2}, {1, 2}, {-3, 2}}));
  const SnapshotPtr finished = wait_until_finished_after_edit(replay, 4);
  EXPECT_FALSE(finished->interrupted);
  replay.edit(delete_first_accepted(*finished));
  replay.edit(drawn(MapEdit::Kind::kWall, {{-1, -0.5}, {-1, 0.5}}));
  MapEdit slow = drawn(MapEdit::Kind::kSlow, {{-2, 0}, {-1.5, 0}, {-1.5, 0.5}});
  slow.percent = 40;
  replay.edit(slow);
  std::swap(slow.percent, slow.max_speed_mps);
  replay.edit(slow);
  const SnapshotPtr refused = wait_until_finished_after_edit(replay, 8);
  EXPECT_EQ(refused->edited->outcome.state, LoopEditOutcome::State::kImpossible);
  EXPECT_THAT(refused->edited->outcome.reason, HasSubstr("Write all limits in the same way"));
  EXPECT_EQ(refused->undo_text, "add slow zone of 40 %");
  EXPECT_EQ(refused->edits->map_edits().size(), 4U);
  EXPECT_EQ(refused->edits->edits().size(), 1U);
  const auto map = wait_for_zones(replay, 2);
  EXPECT_LT(map->raster.rectangle().width_m(), 5.5) << "the map is cropped to 4 m and the margin";
  expect_repeated_without_window(replay, path);
}

TEST_F(ReplayEditsTest, of_the_map_do_not_repeat_the_final_loop_search) {
  Replay replay(log(room_log_lines(150)), settings_);
  replay.set_speed(0);
  replay.play();
  wait_for(replay, ReplayPhase::kFinalSearch);
  replay.pause();
  wait_for(replay, [](const ReplaySnapshot& now) { return now.final_search_held; });
  const MapEdit wall = drawn(MapEdit::Kind::kWall, {{-1, -0.5}, {-1, 0.5}});
  replay.edit(wall);
  replay.undo();
  replay.edit(wall);
  EXPECT_TRUE(wait_for_edit(replay, 3)->final_search_held) << "they are made while the search is held";
  replay.play();
  EXPECT_EQ(wait_for(replay, ReplayPhase::kFinished)->edits->map_edits().size(), 1U);
}

TEST_F(ReplayTest, the_threads_of_a_closed_run_end) {
  Replay replay(log(room_log_lines(60)), settings_);
  replay.set_speed(0);
  replay.play();
  wait_for(replay, ReplayPhase::kFinished);
  EXPECT_FALSE(replay.ended());
  replay.close();
  for (int i = 0; i < 600 && !replay.ended(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_TRUE(replay.ended());
}

TEST_F(ReplayEditsTest, report_why_they_are_impossible) {
  Replay replay(log(room_log_lines(60)), settings_);
  replay.set_speed(0);
  replay.play();
  wait_for(replay, ReplayPhase::kFinished);
  replay.edit({LoopEdit::Kind::kForce, 0, 0});
  const SnapshotPtr after = wait_until_finished_after_edit(replay, 1);
  EXPECT_EQ(after->edited->outcome.state, LoopEditOutcome::State::kImpossible);
  EXPECT_EQ(after->edited->outcome.reason, "scan 0 is part of local map 0");
  EXPECT_TRUE(after->edits->empty());
  EXPECT_EQ(after->undo_text, "");
}

}  // namespace
}  // namespace psi_slam
