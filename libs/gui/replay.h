// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "gui/live_feed.h"
#include "gui/log_outline.h"
#include "gui/log_pace.h"
#include "gui/map_painter.h"
#include "gui/replay_snapshot.h"
#include "session/edit_history.h"
#include "session/edit_journal.h"
#include "session/session_input.h"
#include "session/settings.h"

namespace psi_slam {

class SnapshotMaker;

/// A mapping run that can be watched: runs a MappingSession in a thread of its own. It can play, pause and
/// step, and it publishes snapshots. A run of a live source maps each scan when it arrives, until the source
/// ends or finish() ends it; play(), pause(), step(), hurry_to() and the speed then have no effect on the
/// mapping of scans.
///
///     Replay replay("my.log", settings);      // opens the log in its thread and waits
///     replay.set_speed(5);
///     replay.play();
///     view.show(*replay.snapshot());          // repeatedly
///     replay.export_to("out", false);         // after the run has finished
///
/// Any thread may call any function. All functions return at once; their effects appear in later snapshots.
/// Pausing and stepping do not change the results, which equal those of psi-slam bit by bit.
class Replay {
 public:
  /// Replays a log and makes each edit at its EditTime.
  Replay(const std::filesystem::path& log, const Settings& settings, EditJournal edits = {});
  /// Replays a log or a recording, with the edits of the input.
  Replay(SessionInput input, const Settings& settings);
  /// Maps what a live source sends, with the back end in a thread of its own. The journal of the stream is
  /// deleted when the run is closed. If the run fails, the journal is kept.
  Replay(LiveStream stream, const Settings& settings);
  /// Calls close() and waits for the threads.
  ~Replay();

  const SessionInput& input() const { return input_; }
  /// Path of the log that is read; empty if the input is a recording without a log.
  const std::filesystem::path& log() const { return input_.log(); }
  const Settings& settings() const { return settings_; }

  /// Maps scan after scan at the given speed. The final loop search follows after the last scan.
  void play() {
    change([&] {
      playing_ = true;
      held_ = false;
      pace_.restart();
      due_ = LogPace::Clock::now();
    });
  }
  /// Pauses after the current scan, or within the final loop search (see ReplaySnapshot::final_search_held).
  void pause() {
    change([&] {
      playing_ = false;
      held_ = true;
      steps_ = 0;
      hurry_to_ = 0;
    });
  }
  /// Maps one more scan and pauses. Do not call it during the final loop search, which has no steps.
  void step() {
    change([&] {
      playing_ = false;
      held_ = false;
      ++steps_;
    });
  }
  /// Sets the speed as a multiple of the recorded speed; 0 is as fast as possible. Initially 1.
  void set_speed(double times) {
    change([&] {
      pace_.set_speed(times);
      due_ = LogPace::Clock::now();
    });
  }
  /// Maps as fast as possible until `scans` scans are mapped, then plays or pauses as before.
  void hurry_to(std::size_t scans) {
    change([&] {
      held_ = false;
      hurry_to_ = scans;
    });
  }
  /// Stops reading the log, or ends the live source and maps the scans that have arrived. The final loop
  /// search follows.
  void finish() {
    if (live_) return live_->end();
    change([&] {
      held_ = false;
      finish_ = true;
    });
  }
  /// Stops the final loop search before its end.
  void cut_final_search() {
    change([&] { stop_final_search_ = cut_final_search_ = true; });
  }

  /// Changes a loop by hand, between two scans or after the last scan. An edit after the last scan repeats
  /// the final loop search. ReplaySnapshot::edited has the outcome.
  void edit(const LoopEdit& edit) { request({EditKind::kEdit, edit}); }
  /// Adds an edit of the drawn map, which drawn_map() then shows, also during the final loop search.
  void edit(const MapEdit& edit) { request({EditKind::kEdit, edit}); }
  /// Undoes the last edit made by edit(). Never undoes edits given to the constructor.
  void undo() { request({EditKind::kUndo}); }
  /// Redoes the edit that was undone last.
  void redo() { request({EditKind::kRedo}); }
  /// Number of calls of edit(), undo() and redo(). ReplaySnapshot::edits_served counts the calls that have an
  /// outcome.
  int edits_asked() const { return edits_asked_; }

  /// Writes all results to a folder, once the run is finished. If `replace` is false, the folder must be new
  /// or empty. ReplaySnapshot::exported has the outcome.
  void export_to(std::filesystem::path folder, bool replace) {
    change([&] { export_ = ExportRequest{std::move(folder), replace}; });
  }

  /// Writes the scans mapped so far to a session file and replaces an existing file. The file is written
  /// between two scans or after the final loop search. ReplaySnapshot::saved has the outcome.
  void save_session(std::filesystem::path file) {
    change([&] { save_ = std::move(file); });
  }

  /// Ends the threads as soon as possible, but completes an export that has begun. Does not wait.
  void close();
  /// True once all threads have ended; the destructor then does not wait.
  bool ended() const { return has_ended(thread_) && (!outline_ || outline_->ended()) && painter_.ended(); }

  /// The newest snapshot; never null.
  std::shared_ptr<const ReplaySnapshot> snapshot() const;
  /// The newest drawing of the grid map, or null if there is none yet.
  std::shared_ptr<const DrawnMap> drawn_map() const { return painter_.drawn(); }
  /// Time stamps of all scans of the log, or null until they are known. Always null for a live source.
  LogOutline::Stamps stamps_us() const { return outline_ ? outline_->stamps_us() : nullptr; }
  /// How the mapping follows the live source; empty for a log.
  std::optional<LiveFigures> live_figures() const {
    return live_ ? std::optional(live_->figures()) : std::nullopt;
  }

 private:
  enum class Turn { kStep, kEdit, kSave, kExport, kFinish, kClose };
  enum class EditKind { kEdit, kUndo, kRedo };
  struct EditRequest {
    EditKind kind = EditKind::kEdit;
    AnyEdit edit{};
    bool is_of_loop() const { return kind == EditKind::kEdit && std::holds_alternative<LoopEdit>(edit); }
  };
  struct ExportRequest {
    std::filesystem::path folder;
    bool replace = false;
  };

  Replay(const std::shared_ptr<LiveFeed>& live, const Settings& settings);
  Replay(SessionInput input, const Settings& settings, std::shared_ptr<LiveFeed> live);

  /// Changes requests under the lock and wakes the mapping thread.
  template <class Change>
  void change(const Change& make_change) {
    locked(make_change);
    changed_.notify_all();
  }
  template <class Action>
  auto locked(const Action& action) {
    const std::lock_guard lock(mutex_);
    return action();
  }
  void request(const EditRequest& edit) {
    ++edits_asked_;
    change([&] {
      edit_requests_.push_back(edit);
      if (edit.is_of_loop()) stop_final_search_ = true;
    });
  }
  void run() noexcept;
  void work();
  void map_until_closed(MappingSession& session);
  bool map_scans(MappingSession& session);
  Turn next_turn();
  bool is_next_scan_due() const;
  void wait_for_scan(std::unique_lock<std::mutex>& lock);
  std::optional<Turn> urgent_turn() const;
  void finish_map(MappingSession& session);
  bool serve_finished(MappingSession& session);
  void serve_edits(MappingSession& session);
  bool make_edit(MappingSession& session, const EditRequest& request);
  void make_loop_edit(MappingSession& session, const EditHistory::Reversal& wanted, bool is_new);
  void make_map_edit(MappingSession& session, const MapEdit& edit, bool is_new);
  void undo_map_edit(MappingSession& session, const MapEdit& edit);
  void note_edits(const MappingSession& session);
  bool concerns_loop(const EditRequest& request) const;
  void serve_map_edits();
  void save_once(const MappingSession& session);
  void export_once(MappingSession& session);
  void observe(const SessionProgress& progress);
  void follow_live(std::size_t scans);
  void hold_final_search();
  void publish();
  void publish_unlocked(std::unique_lock<std::mutex>& lock);
  void publish_as_it_is();
  LogPace::Clock::time_point next_publication() const;
  void refuse_requests();

  const SessionInput input_;
  const Settings settings_;
  const std::shared_ptr<LiveFeed> live_;       // null for a log
  const std::unique_ptr<LogOutline> outline_;  // null for a live source
  MapPainter painter_;

  // Used by the mapping thread only.
  std::unique_ptr<SnapshotMaker> maker_;
  EditHistory edit_history_;
  int edits_made_ = 0;
  bool final_search_stopped_ = false;  // an edit stopped the final loop search, so it must be repeated
  MappingSession* session_ = nullptr;  // null before the session opens and after the final loop search
  ReplayPhase phase_ = ReplayPhase::kOpening;
  bool stale_ = false;        // the last snapshot is out of date
  bool is_recorded_ = false;  // the journal keeps the scans of a run that failed
  LogPace::Clock::time_point published_at_;
  LogPace::Clock::duration publishing_took_{};
  int exports_ = 0;
  int saves_ = 0;

  mutable std::mutex snapshot_mutex_;
  std::shared_ptr<const ReplaySnapshot> snapshot_;

  std::mutex mutex_;  // guards the members from here to scans_
  std::condition_variable changed_;
  bool playing_ = false;
  bool held_ = false;  // the final loop search is paused
  std::size_t steps_ = 0;
  std::size_t hurry_to_ = 0;  // number of scans to map as fast as possible
  LogPace pace_;
  LogPace::Clock::time_point due_;  // when the next scan is due, while playing
  bool finish_ = false;
  bool close_ = false;
  bool cut_final_search_ = false;
  std::vector<EditRequest> edit_requests_;
  std::optional<ExportRequest> export_;
  std::optional<std::filesystem::path> save_;
  std::size_t scans_ = 0;  // number of scans mapped so far

  std::atomic<bool> stop_final_search_{false};  // ends the final loop search, also to repeat it after edits
  std::atomic<int> edits_asked_{0};
  std::future<void> thread_;
};

}  // namespace psi_slam
