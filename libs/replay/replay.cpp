// SPDX-License-Identifier: BSD-3-Clause
#include "replay/replay.h"
#include "report/output_folder.h"

#include <algorithm>
#include <new>
#include <utility>

#include "replay/background_thread.h"
#include "psi_slam/user_error.h"
#include "replay/snapshot_maker.h"

namespace psi_slam {
namespace {

using Clock = LogPace::Clock;

constexpr std::chrono::milliseconds kBetweenSnapshots{100};
constexpr int kWorkPerPublishing = 20;  // snapshots cost the engine at most a twentieth of its time

/// Why `write` could not write `what`, a sentence; empty: it could.
template <class Write>
std::string failure_of(const Write& write, const std::string& what) {
  try {
    write();
  } catch (const std::bad_alloc&) {
    return "there is not enough memory to write " + what;
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

PsiThresholds thresholds(const Settings& settings) {
  return {settings.mapper.back_end.psi.psi_1, settings.mapper.back_end.psi.psi_2};
}

}  // namespace

Replay::Replay(const std::filesystem::path& log, const Settings& settings, EditJournal edits)
    : Replay(SessionInput(log).with_edits(std::move(edits)), settings) {}

Replay::Replay(SessionInput input, const Settings& settings)
    : input_(std::move(input)),
      settings_(settings),
      outline_(input_, log_options(settings)),
      painter_(settings.map),
      maker_(std::make_unique<SnapshotMaker>(thresholds(settings), input_.edits().edits())),
      snapshot_(maker_->snapshot(phase_)),
      thread_([this] { run(); }) {}

Replay::~Replay() {
  close();
  thread_.join();
}

template <class Change>
void Replay::tell(Change change) {
  {
    const std::lock_guard lock(mutex_);
    change();
  }
  changed_.notify_all();
}

void Replay::play() {
  tell([&] {
    playing_ = true;
    held_ = false;
    pace_.restart();
    due_ = Clock::now();
  });
}

void Replay::pause() {
  tell([&] {
    playing_ = false;
    held_ = true;
    steps_ = 0;
    hurry_to_ = 0;
  });
}

void Replay::step() {
  tell([&] {
    playing_ = false;
    held_ = false;
    ++steps_;
  });
}

void Replay::set_speed(double times) {
  tell([&] {
    pace_.set_speed(times);
    due_ = Clock::now();
  });
}

void Replay::hurry_to(std::size_t scans) {
  tell([&] {
    held_ = false;
    hurry_to_ = scans;
  });
}

void Replay::finish() {
  tell([&] {
    held_ = false;
    finish_ = true;
  });
}

void Replay::cut_final_search() {
  tell([&] {
    cut_final_search_ = true;
    stop_final_search_ = true;
  });
}

void Replay::edit(const LoopEdit& edit) {
  wish({EditKind::kEdit, edit});
}

void Replay::undo() {
  wish({EditKind::kUndo});
}

void Replay::redo() {
  wish({EditKind::kRedo});
}

void Replay::wish(const EditWish& edit) {
  ++edits_asked_;
  tell([&] {
    edit_wishes_.push_back(edit);
    stop_final_search_ = true;
  });
}

void Replay::export_to(std::filesystem::path folder, bool replace) {
  tell([&] { export_ = ExportWish{std::move(folder), replace}; });
}

void Replay::save_session(std::filesystem::path file) {
  tell([&] { save_ = std::move(file); });
}

void Replay::close() {
  tell([&] {
    close_ = true;
    stop_final_search_ = true;
  });
  outline_.stop();
  painter_.stop();
}

std::shared_ptr<const ReplaySnapshot> Replay::snapshot() const {
  const std::lock_guard lock(snapshot_mutex_);
  return snapshot_;
}

void Replay::run() noexcept {
  give_way();
  try {
    work();
  } catch (const std::bad_alloc&) {
    fail("there is not enough memory");
  } catch (const std::exception& error) {
    fail(error.what());
  }
  refuse_wishes();
  ended_ = true;
}

void Replay::work() {
  MappingSession session(input_, settings_);
  session.set_observer([&](const SessionProgress& progress) { observe(progress); });
  session.stay_open();
  session_ = &session;
  if (!map_scans(session)) return;
  do {
    finish_map(session);
  } while (serve_finished(session));
}

void Replay::finish_map(MappingSession& session) {
  phase_ = ReplayPhase::kFinalSearch;
  publish();  // all scans, as long as the mapper can be followed
  {
    const std::lock_guard lock(mutex_);
    stop_final_search_ = close_ || cut_final_search_ || !edit_wishes_.empty();
  }
  session.finish(stop_final_search_);
  session_ = nullptr;
  {
    const std::lock_guard lock(mutex_);
    final_search_stopped_ = stop_final_search_ && !cut_final_search_ && !close_;
  }
  maker_->note_warnings(session.warnings());
  maker_->take(session.result());
  painter_.request(maker_->sketch());
}

/// Until the end of the log, or until told to; false when told to close.
bool Replay::map_scans(MappingSession& session) {
  while (true) {
    const Turn turn = next_turn();
    if (turn == Turn::kClose) return false;
    if (turn == Turn::kEdit) {
      serve_edits(session);
      continue;
    }
    if (turn == Turn::kSave) {
      save_once(session);
      publish();
      continue;
    }
    if (turn == Turn::kFinish || !session.step()) return true;
    const std::lock_guard lock(mutex_);
    due_ = pace_.due_after(session.mapper().frames().back().time_us, Clock::now());
  }
}

Replay::Turn Replay::next_turn() {
  std::unique_lock lock(mutex_);
  while (true) {
    if (const auto turn = urgent_turn()) return *turn;
    if (finish_) return Turn::kFinish;
    if (hurry_to_ > 0 && scans_ >= hurry_to_) {
      hurry_to_ = 0;
      pace_.restart();
    }
    const bool hurries = hurry_to_ > 0 || (playing_ && Clock::now() >= due_);
    if (steps_ > 0 || hurries || playing_) {
      phase_ = ReplayPhase::kPlaying;
      if (steps_ > 0) {
        --steps_;
        return Turn::kStep;
      }
      if (hurries) return Turn::kStep;
      wait_for_due_scan(lock);
      continue;
    }
    if (phase_ != ReplayPhase::kPaused || stale_) {
      phase_ = ReplayPhase::kPaused;
      lock.unlock();
      publish();
      lock.lock();
      continue;
    }
    changed_.wait(lock);
  }
}

/// Shows meanwhile what has not been shown.
void Replay::wait_for_due_scan(std::unique_lock<std::mutex>& lock) {
  if (stale_ && Clock::now() >= next_publication()) {
    lock.unlock();
    publish();
    lock.lock();
    return;
  }
  changed_.wait_until(lock, stale_ ? std::min(due_, next_publication()) : due_);
}

/// Exports and edits; true when the map is to be finished again, false when told to close.
bool Replay::serve_finished(MappingSession& session) {
  while (true) {
    const Turn turn = next_turn_when_finished();
    if (turn == Turn::kClose) break;
    if (turn == Turn::kSave) save_once(session);
    if (turn == Turn::kExport) export_once(session);
    if (turn == Turn::kEdit) serve_edits(session);
    if (!session.finished()) return true;
  }
  return false;
}

Replay::Turn Replay::next_turn_when_finished() {
  std::unique_lock lock(mutex_);
  if (!urgent_turn()) {
    held_ = false;
    phase_ = ReplayPhase::kFinished;
    lock.unlock();
    publish();
    lock.lock();
  }
  changed_.wait(lock, [this] { return urgent_turn() || export_; });
  return urgent_turn().value_or(Turn::kExport);
}

/// What comes before anything else, in this order.
std::optional<Replay::Turn> Replay::urgent_turn() const {
  if (close_) return Turn::kClose;
  if (!edit_wishes_.empty()) return Turn::kEdit;
  if (save_) return Turn::kSave;
  return std::nullopt;
}

void Replay::serve_edits(MappingSession& session) {
  std::vector<EditWish> wishes;
  {
    const std::lock_guard lock(mutex_);
    wishes.swap(edit_wishes_);
    cut_final_search_ = false;
  }
  for (const EditWish& wish : wishes) make_edit(session, wish);
  maker_->note_served(static_cast<int>(wishes.size()));
  if (session.finished()) {  // nothing was changed
    if (!final_search_stopped_) return;
    session.reopen();
  }
  if (phase_ == ReplayPhase::kFinished) phase_ = ReplayPhase::kFinalSearch;
  stale_ = true;
  session_ = &session;
  maker_->note_edits(session.edits().edits(), edit_history_);
  publish();
}

void Replay::make_edit(MappingSession& session, const EditWish& wish) {
  EditHistory::Reversal wanted{wish.edit, {}};
  if (wish.kind == EditKind::kUndo) {
    auto back = edit_history_.undo();
    if (!back) return;
    wanted = *std::move(back);
  } else if (wish.kind == EditKind::kRedo) {
    const auto again = edit_history_.redo();
    if (!again) return;
    wanted.edit = *again;
  }
  const std::optional<LoopEdit> before = session.edits().in_force(wanted.edit);
  std::vector<TimedEdit> later = session.edits().to_come(wanted.edit);
  const LoopEditOutcome outcome = session.edit(wanted.edit);
  session.plan(wanted.later);
  const bool made = outcome.state != LoopEditOutcome::State::kImpossible;
  if (made && wish.kind == EditKind::kEdit) edit_history_.note(wanted.edit, before, std::move(later));
  maker_->note_edited({++edits_made_, wanted.edit, outcome});
}

void Replay::save_once(const MappingSession& session) {
  SaveOutcome outcome{++saves_, {}, "", "", {}};
  {
    const std::lock_guard lock(mutex_);
    outcome.file = std::exchange(save_, std::nullopt).value();
  }
  SavedSession saved;
  outcome.failure = failure_of([&] { saved = session.save(outcome.file); }, "the session");
  outcome.remark = saved.remark;
  outcome.written.scans = saved.scans;
  maker_->note_save(std::move(outcome));
}

void Replay::export_once(MappingSession& session) {
  ExportWish wish;
  {
    const std::lock_guard lock(mutex_);
    wish = std::exchange(export_, std::nullopt).value();
  }
  phase_ = ReplayPhase::kExporting;
  publish();
  ExportOutcome outcome{++exports_, wish.folder, "", {}};
  outcome.failure =
      failure_of([&] { session.export_to(OutputFolder::prepare(wish.folder, wish.replace)); }, "the results");
  maker_->note_export(std::move(outcome));
}

void Replay::observe(const SessionProgress& progress) {
  maker_->note_progress(progress);
  if (progress.phase == SessionProgress::Phase::kMapping) {
    maker_->note_scan(progress.share);
    stale_ = true;
    const std::lock_guard lock(mutex_);
    scans_ = progress.scans;
  } else if (session_ != nullptr) {
    maker_->follow_local_maps(session_->mapper());
  }
  if (Clock::now() >= next_publication()) publish();
  if (progress.phase == SessionProgress::Phase::kFinalSearch) hold_final_search();
}

/// As long as it is paused.
void Replay::hold_final_search() {
  const auto goes_on = [this] { return !held_ || stop_final_search_; };
  std::unique_lock lock(mutex_);
  if (goes_on()) return;
  lock.unlock();
  maker_->note_held(true);
  publish();
  lock.lock();
  changed_.wait(lock, goes_on);
  lock.unlock();
  maker_->note_held(false);
  publish();
}

Clock::time_point Replay::next_publication() const {
  return published_at_ + std::max<Clock::duration>(kBetweenSnapshots, kWorkPerPublishing * publishing_took_);
}

void Replay::publish() {
  const auto start = Clock::now();
  if (session_ != nullptr) {
    maker_->follow(session_->mapper(), phase_ == ReplayPhase::kPaused
                                           ? SnapshotMaker::ActiveMaps::kAtOnce
                                           : SnapshotMaker::ActiveMaps::kNowAndThen);
    maker_->note_warnings(session_->warnings());
    if (stale_) painter_.request(maker_->sketch());
  }
  auto snapshot = maker_->snapshot(phase_);
  {
    const std::lock_guard lock(snapshot_mutex_);
    snapshot_ = std::move(snapshot);
  }
  stale_ = false;
  published_at_ = Clock::now();
  publishing_took_ = published_at_ - start;
}

/// What was asked for and can no longer be done, is told.
void Replay::refuse_wishes() {
  session_ = nullptr;
  const std::lock_guard lock(mutex_);
  const auto words = [](const std::filesystem::path& path) {
    return path.string() + " was not written: the run ended before it could be";
  };
  if (save_) maker_->note_save({++saves_, *save_, words(*save_), "", {}});
  if (export_) maker_->note_export({++exports_, export_->folder, words(export_->folder), {}});
  const std::lock_guard snapshot_lock(snapshot_mutex_);
  snapshot_ = maker_->snapshot(phase_);
}

void Replay::fail(const std::string& sentence) {
  session_ = nullptr;
  phase_ = ReplayPhase::kFailed;
  maker_->note_failure(sentence);
  const std::lock_guard lock(snapshot_mutex_);
  snapshot_ = maker_->snapshot(phase_);
}

}  // namespace psi_slam
