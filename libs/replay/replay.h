// SPDX-License-Identifier: BSD-3-Clause
// A mapping run that can be watched: a MappingSession in a thread of its own, which is told to play, pause or
// step, and publishes snapshots of what it does.
//
//     Replay replay("my.log", settings);      // opens in its thread, and waits
//     replay.set_speed(5);
//     replay.play();
//     view.show(*replay.snapshot());          // now and then
//     replay.export_to("out", false);         // once it is finished
//
// All functions may be called by any thread and return at once; what they ask for shows in later snapshots.
// The results are those of the headless program to the last bit, however the run was played.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "replay/log_outline.h"
#include "replay/log_pace.h"
#include "replay/map_painter.h"
#include "replay/replay_snapshot.h"
#include "session/edit_history.h"
#include "session/edit_journal.h"
#include "session/session_input.h"
#include "session/settings.h"

namespace psi_slam {

class SnapshotMaker;

class Replay {
 public:
  /// `edits` are made on the way, each at its time.
  Replay(const std::filesystem::path& log, const Settings& settings, EditJournal edits = {});
  /// The same of a recording, see SessionInput.
  Replay(SessionInput input, const Settings& settings);
  /// Closes, and waits for it.
  ~Replay();
  Replay(const Replay&) = delete;
  Replay& operator=(const Replay&) = delete;

  const SessionInput& input() const { return input_; }
  /// That is read; empty where a recording is all there is.
  const std::filesystem::path& log() const { return input_.log(); }
  const Settings& settings() const { return settings_; }

  /// Maps scan after scan, at the speed set. At the end of the log the last pass follows by itself.
  void play();
  /// Between two scans, or in the midst of the last pass: see ReplaySnapshot::final_search_held.
  void pause();
  /// Maps one more scan, and pauses. (The last pass has no steps.)
  void step();
  /// Times the speed of the recording; 0: as fast as possible. It is 1 at first.
  void set_speed(double times);
  /// Goes on as fast as possible until so many scans were mapped, and then as before.
  void hurry_to(std::size_t scans);
  /// Reads no further: the last pass follows, and the map is of the scans mapped until then.
  void finish();
  /// The last pass ends where it is.
  void cut_final_search();

  /// Changes a loop by hand, between two scans or after the last one: then the last pass follows again. What
  /// became of it is ReplaySnapshot::edited.
  void edit(const LoopEdit& edit);
  /// The edits made here, not those that it began with.
  void undo();
  void redo();
  /// Of these three; ReplaySnapshot::edits_served tells how many have been seen to.
  int edits_asked() const { return edits_asked_; }

  /// Writes all results once the run is finished; a request before waits for that. See
  /// ReplaySnapshot::exported.
  void export_to(std::filesystem::path folder, bool replace);

  /// Writes what was mapped until now as a session file, which is replaced: between two scans, or once the
  /// last pass has ended. See ReplaySnapshot::saved.
  void save_session(std::filesystem::path file);

  /// Ends the threads as soon as may be, mapping or not; an export under way is written to its end.
  void close();
  /// All threads have come to their ends: the destructor will not wait.
  bool ended() const { return ended_ && outline_.ended() && painter_.ended(); }

  /// Never null.
  std::shared_ptr<const ReplaySnapshot> snapshot() const;
  /// The gridmap as it was drawn last, or null.
  std::shared_ptr<const DrawnMap> drawn_map() const { return painter_.drawn(); }
  /// When each scan of the whole log was taken, or null as long as that is not known.
  std::shared_ptr<const std::vector<TimeUs>> stamps_us() const { return outline_.stamps_us(); }

 private:
  enum class Turn { kStep, kEdit, kSave, kExport, kFinish, kClose };
  enum class EditKind { kEdit, kUndo, kRedo };
  struct EditWish {
    EditKind kind = EditKind::kEdit;
    LoopEdit edit{};
  };
  struct ExportWish {
    std::filesystem::path folder;
    bool replace = false;
  };

  /// Changes what is wished for, and wakes the engine's thread.
  template <class Change>
  void tell(Change change);
  void run() noexcept;
  void work();
  bool map_scans(MappingSession& session);
  Turn next_turn();
  Turn next_turn_when_finished();
  std::optional<Turn> urgent_turn() const;
  void wait_for_due_scan(std::unique_lock<std::mutex>& lock);
  void finish_map(MappingSession& session);
  bool serve_finished(MappingSession& session);
  void wish(const EditWish& edit);
  void serve_edits(MappingSession& session);
  void make_edit(MappingSession& session, const EditWish& wish);
  void save_once(const MappingSession& session);
  void export_once(MappingSession& session);
  void observe(const SessionProgress& progress);
  void hold_final_search();
  void publish();
  LogPace::Clock::time_point next_publication() const;
  void fail(const std::string& sentence);
  void refuse_wishes();

  const SessionInput input_;
  const Settings settings_;
  LogOutline outline_;
  MapPainter painter_;

  // The engine's thread only.
  std::unique_ptr<SnapshotMaker> maker_;
  EditHistory edit_history_;
  int edits_made_ = 0;
  bool final_search_stopped_ = false;     // for edits, and is to be begun anew
  MappingSession* session_ = nullptr;  // while its mapper can be followed
  ReplayPhase phase_ = ReplayPhase::kOpening;
  bool stale_ = false;  // something happened since the last snapshot
  LogPace::Clock::time_point published_at_;
  LogPace::Clock::duration publishing_took_{};
  int exports_ = 0;
  int saves_ = 0;

  mutable std::mutex snapshot_mutex_;
  std::shared_ptr<const ReplaySnapshot> snapshot_;

  std::mutex mutex_;  // of what is wished for
  std::condition_variable changed_;
  bool playing_ = false;
  bool held_ = false;  // the last pass, if it is on
  std::size_t steps_ = 0;
  std::size_t hurry_to_ = 0;  // scans
  LogPace pace_;
  LogPace::Clock::time_point due_;  // the next scan, when playing
  bool finish_ = false;
  bool close_ = false;
  bool cut_final_search_ = false;
  std::vector<EditWish> edit_wishes_;
  std::optional<ExportWish> export_;
  std::optional<std::filesystem::path> save_;
  std::size_t scans_ = 0;  // mapped

  std::atomic<bool> stop_final_search_{false};  // cut, or to be begun anew
  std::atomic<int> edits_asked_{0};
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

}  // namespace psi_slam
