// SPDX-License-Identifier: BSD-3-Clause
#include "gui/replay.h"

#include <algorithm>
#include <new>

#include "base/failure_notice.h"
#include "base/scope_exit.h"
#include "gui/snapshot_maker.h"
#include "map/report/output_folder.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using Clock = LogPace::Clock;

constexpr std::chrono::milliseconds kBetweenSnapshots{100};
constexpr std::chrono::seconds kBetweenSnapshotsInHaste{1};  // while scans of a live source wait
constexpr int kWorkPerPublishing = 20;  // making snapshots takes at most 1/20 of the thread's time

/// Calls `action`. Returns why it failed, as a sentence: `out_of_memory` if memory ran out. Empty after
/// success.
template <class Action>
std::string failure_of(const Action& action, const char* out_of_memory) {
  try {
    action();
  } catch (const std::bad_alloc&) {
    return out_of_memory;
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

}  // namespace

Replay::Replay(const std::filesystem::path& log, const Settings& settings, EditJournal edits)
    : Replay(SessionInput(log).with_edits(std::move(edits)), settings) {}

Replay::Replay(SessionInput input, const Settings& settings) : Replay(std::move(input), settings, nullptr) {}

Replay::Replay(LiveStream stream, const Settings& settings)
    : Replay(std::make_shared<LiveFeed>(std::move(stream)), settings) {}

Replay::Replay(const std::shared_ptr<LiveFeed>& live, const Settings& settings)
    : Replay(LiveFeed::input(live), settings, live) {}

Replay::Replay(SessionInput input, const Settings& settings, std::shared_ptr<LiveFeed> live)
    : input_(std::move(input)),
      settings_(settings),
      live_(std::move(live)),
      outline_(live_ ? nullptr : std::make_unique<LogOutline>(input_, log_options(settings))),
      painter_(settings.map, settings.map_frame, input_.edits().map_edits()),
      maker_(std::make_unique<SnapshotMaker>(
          PsiThresholds{settings.mapper.back_end.psi.psi_1, settings.mapper.back_end.psi.psi_2},
          input_.edits(), live_ != nullptr)),
      snapshot_(maker_->snapshot(phase_)),
      thread_(run_in_background([this] { run(); })) {}

Replay::~Replay() {
  close();
}

void Replay::close() {
  change([&] {
    close_ = true;
    stop_final_search_ = true;
  });
  if (live_) live_->end();
  if (outline_) outline_->stop();
  painter_.stop();
}

std::shared_ptr<const ReplaySnapshot> Replay::snapshot() const {
  const std::lock_guard lock(snapshot_mutex_);
  return snapshot_;
}

void Replay::run() noexcept {
  maker_->now.failure = failure_of(
      [&] { work(); }, "Out of memory: the run has stopped. Close other programs or map a shorter log.");
  if (!maker_->now.failure.empty()) {
    phase_ = ReplayPhase::kFailed;
    if (is_recorded_)
      maker_->now.failure += std::string(maker_->now.failure.back() == '.' ? "" : ".") +
                             " The scans so far are recorded in " + live_->journal().string() +
                             ". Open this file to map them again.";
  }
  refuse_requests();
}

void Replay::work() {
  if (live_) live_->set_observer([this] { change([] {}); });
  MappingSession session(input_, settings_);
  const ScopeExit end_feed([this] {  // the session waits for it when it is destroyed
    if (live_) live_->end();
  });
  session.set_observer([&](const SessionProgress& progress) { observe(progress); });
  if (live_)
    session.set_pose_observer(
        [&](const FrameRecord&) { live_->note_pose(session.mapper().missed_deadlines()); });
  session.stay_open();
  session_ = &session;
  if (live_ && !live_->journal().empty()) session.start_journal(live_->journal());
  try {
    map_until_closed(session);
  } catch (...) {
    is_recorded_ = live_ && !live_->journal().empty() && scans_ > 0;
    if (!is_recorded_) session.remove_journal();
    throw;
  }
  session.remove_journal();
}

void Replay::map_until_closed(MappingSession& session) {
  if (!map_scans(session)) return;
  do {
    finish_map(session);
  } while (serve_finished(session));
}

void Replay::finish_map(MappingSession& session) {
  phase_ = ReplayPhase::kFinalSearch;
  publish();  // the last snapshot before finish(), with all scans
  locked([&] {
    stop_final_search_ = close_ || cut_final_search_ ||
                         std::any_of(edit_requests_.begin(), edit_requests_.end(),
                                     [](const EditRequest& request) { return request.is_of_loop(); });
  });
  session.finish(stop_final_search_);
  session_ = nullptr;
  locked([&] { final_search_stopped_ = stop_final_search_ && !cut_final_search_ && !close_; });
  maker_->now.warnings = session.warnings();
  maker_->take(session.result());
  painter_.request(maker_->sketch());
}

/// Maps until the end of the log or finish(). Returns false after close().
bool Replay::map_scans(MappingSession& session) {
  while (true) {
    const Turn turn = next_turn();
    if (turn == Turn::kClose) return false;
    if (turn == Turn::kEdit) serve_edits(session);
    if (turn == Turn::kSave) {
      save_once(session);
      publish();
    }
    if (turn == Turn::kFinish || (turn == Turn::kStep && !session.step())) return true;
    const std::lock_guard lock(mutex_);
    if (turn == Turn::kStep) due_ = pace_.due_after(session.mapper().frames().back().time_us, Clock::now());
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
    if (is_next_scan_due()) {
      phase_ = ReplayPhase::kPlaying;
      if (steps_ > 0) --steps_;
      return Turn::kStep;
    }
    if (playing_ || live_) {
      wait_for_scan(lock);
      continue;
    }
    if (phase_ != ReplayPhase::kPaused || stale_) {
      phase_ = ReplayPhase::kPaused;
      publish_unlocked(lock);
      continue;
    }
    changed_.wait(lock);
  }
}

bool Replay::is_next_scan_due() const {
  if (live_) return live_->has_news(scans_);
  return steps_ > 0 || hurry_to_ > 0 || (playing_ && Clock::now() >= due_);
}

/// Waits until the next scan is due or requests have changed. Publishes meanwhile.
void Replay::wait_for_scan(std::unique_lock<std::mutex>& lock) {
  const bool begins = std::exchange(phase_, ReplayPhase::kPlaying) != ReplayPhase::kPlaying;
  if (begins || (stale_ && Clock::now() >= next_publication()))
    publish_unlocked(lock);
  else if (stale_)
    changed_.wait_until(lock, live_ ? next_publication() : std::min(due_, next_publication()));
  else if (live_)
    changed_.wait(lock);
  else
    changed_.wait_until(lock, due_);
}

/// Serves exports, saves and edits of a finished run. Returns true if the map must be finished again, false
/// after close().
bool Replay::serve_finished(MappingSession& session) {
  while (true) {
    std::unique_lock lock(mutex_);
    if (!urgent_turn()) {
      held_ = false;
      phase_ = ReplayPhase::kFinished;
      publish_unlocked(lock);
    }
    changed_.wait(lock, [this] { return urgent_turn() || export_; });
    const Turn turn = urgent_turn().value_or(Turn::kExport);
    lock.unlock();
    if (turn == Turn::kClose) return false;
    if (turn == Turn::kSave) save_once(session);
    if (turn == Turn::kExport) export_once(session);
    if (turn == Turn::kEdit) serve_edits(session);
    if (!session.finished()) return true;
  }
}

/// Returns the most urgent request that goes before mapping and exporting; nothing if there is none.
std::optional<Replay::Turn> Replay::urgent_turn() const {
  if (close_) return Turn::kClose;
  if (!edit_requests_.empty()) return Turn::kEdit;
  if (save_) return Turn::kSave;
  return std::nullopt;
}

void Replay::serve_edits(MappingSession& session) {
  const std::vector<EditRequest> requests = locked([&] {
    cut_final_search_ = false;
    return std::exchange(edit_requests_, {});
  });
  bool concerned_loops = false;
  for (const EditRequest& request : requests) concerned_loops |= make_edit(session, request);
  maker_->now.edits_served += static_cast<int>(requests.size());
  note_edits(session);
  if (session.finished()) {  // no loop could be edited
    if (!final_search_stopped_) return;
    session.reopen();
    concerned_loops = true;
  }
  if (phase_ == ReplayPhase::kFinished) phase_ = ReplayPhase::kFinalSearch;
  session_ = &session;
  if (concerned_loops) {
    stale_ = true;
    maker_->note_changed_loops();
  }
  publish();
}

/// Makes, undoes or redoes an edit. Returns whether it is an edit of a loop.
bool Replay::make_edit(MappingSession& session, const EditRequest& request) {
  const bool of_loop = concerns_loop(request);
  if (request.kind == EditKind::kUndo) {
    const auto back = edit_history_.undo();
    if (back && of_loop) make_loop_edit(session, std::get<EditHistory::Reversal>(*back), false);
    if (back && !of_loop) undo_map_edit(session, std::get<MapEdit>(*back));
    return of_loop;
  }
  const bool is_new = request.kind == EditKind::kEdit;
  const std::optional<AnyEdit> edit = is_new ? request.edit : edit_history_.redo();
  if (edit && of_loop) make_loop_edit(session, {std::get<LoopEdit>(*edit), {}}, is_new);
  if (edit && !of_loop) make_map_edit(session, std::get<MapEdit>(*edit), is_new);
  return of_loop;
}

void Replay::make_loop_edit(MappingSession& session, const EditHistory::Reversal& wanted, bool is_new) {
  const std::optional<LoopEdit> before = session.edits().in_force(wanted.edit);
  std::vector<TimedEdit> later = session.edits().to_come(wanted.edit);
  const LoopEditOutcome outcome = session.edit(wanted.edit);
  session.plan(wanted.later);
  const bool made = outcome.state != LoopEditOutcome::State::kImpossible;
  if (made && is_new) edit_history_.note(wanted.edit, before, std::move(later));
  maker_->now.edited = EditOutcome{++edits_made_, wanted.edit, outcome};
}

void Replay::make_map_edit(MappingSession& session, const MapEdit& edit, bool is_new) {
  LoopEditOutcome outcome;
  try {
    session.edit(edit);
    if (is_new) edit_history_.note(edit);
  } catch (const UserError& error) {
    outcome = {LoopEditOutcome::State::kImpossible, error.what()};
  }
  maker_->now.edited = EditOutcome{++edits_made_, edit, outcome};
}

void Replay::undo_map_edit(MappingSession& session, const MapEdit& edit) {
  session.remove_last_map_edit();  // all later ones were undone before
  maker_->now.edited = EditOutcome{++edits_made_, edit, {}, true};
}

/// Shows the edits of the session.
void Replay::note_edits(const MappingSession& session) {
  maker_->note_edits(session.edits(), edit_history_);
  painter_.show_edits(session.edits().map_edits());
}

/// Returns whether a request makes, undoes or redoes an edit of a loop.
bool Replay::concerns_loop(const EditRequest& request) const {
  if (request.kind == EditKind::kEdit) return request.is_of_loop();
  const AnyEdit* const edit =
      request.kind == EditKind::kUndo ? edit_history_.next_undo() : edit_history_.next_redo();
  return edit != nullptr && std::holds_alternative<LoopEdit>(*edit);
}

/// Makes the waiting edits of the drawn map during the final loop search. An edit of a loop stops the search,
/// and serve_edits() makes it.
void Replay::serve_map_edits() {
  const auto next = [this]() -> std::optional<EditRequest> {
    const std::lock_guard lock(mutex_);
    if (edit_requests_.empty()) return std::nullopt;
    const EditRequest request = edit_requests_.front();
    if (concerns_loop(request)) {
      stop_final_search_ = true;
      return std::nullopt;
    }
    edit_requests_.erase(edit_requests_.begin());
    return request;
  };
  while (const std::optional<EditRequest> request = next()) {
    make_edit(*session_, *request);
    ++maker_->now.edits_served;
    note_edits(*session_);
    publish_as_it_is();
  }
}

void Replay::save_once(const MappingSession& session) {
  WriteOutcome outcome{++saves_, {}, "", "", {}};
  outcome.path = locked([&] { return std::exchange(save_, std::nullopt).value(); });
  SavedSession saved;
  outcome.failure =
      failure_of([&] { saved = session.save(outcome.path); },
                 "Out of memory while writing the session. Close other programs and save it again.");
  outcome.remark = saved.remark;
  outcome.written.scans = saved.scans;
  maker_->note_save(std::move(outcome));
}

void Replay::export_once(MappingSession& session) {
  const ExportRequest request = locked([&] { return std::exchange(export_, std::nullopt).value(); });
  phase_ = ReplayPhase::kExporting;
  publish();
  WriteOutcome outcome{++exports_, request.folder, "", "", {}};
  outcome.failure =
      failure_of([&] { session.export_to(OutputFolder::prepare(request.folder, request.replace)); },
                 "Out of memory while writing the results. Close other programs and export them again.");
  maker_->now.warnings = session.warnings();  // with the edits beside the drawn map
  maker_->note_export(std::move(outcome));
}

void Replay::observe(const SessionProgress& progress) {
  maker_->now.progress = progress;
  if (progress.phase == SessionProgress::Phase::kMapping) {
    maker_->note_scan(progress.share);
    stale_ = true;
    locked([&] { scans_ = progress.scans; });
    if (live_) return follow_live(progress.scans);
  } else if (session_ != nullptr) {
    maker_->follow_local_maps(session_->mapper());
  }
  if (Clock::now() >= next_publication()) publish();
  if (progress.phase == SessionProgress::Phase::kPriorSearch ||
      progress.phase == SessionProgress::Phase::kFinalSearch) {
    serve_map_edits();
    hold_final_search();
  }
}

/// Publishes only now and then while scans wait, because a snapshot waits for the back end.
void Replay::follow_live(std::size_t scans) {
  if (session_ == nullptr) return;
  if (live_->has_news(scans) && Clock::now() >= published_at_ + kBetweenSnapshotsInHaste) publish();
}

/// Waits while the final loop search is paused.
void Replay::hold_final_search() {
  const auto continues = [this] { return !held_ || stop_final_search_; };
  std::unique_lock lock(mutex_);
  if (continues()) return;
  maker_->now.final_search_held = true;
  publish_unlocked(lock);
  while (!continues()) {
    changed_.wait(lock, [&] { return continues() || !edit_requests_.empty(); });
    lock.unlock();
    serve_map_edits();
    lock.lock();
  }
  lock.unlock();
  maker_->now.final_search_held = false;
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
    maker_->now.warnings = session_->warnings();
    if (const auto why = session_->journal_failure())
      maker_->now.warnings.push_back(unwritten_text("the journal", *why));
    if (stale_) painter_.request(maker_->sketch());
  }
  publish_as_it_is();
  stale_ = false;
  published_at_ = Clock::now();
  publishing_took_ = published_at_ - start;
}

void Replay::publish_unlocked(std::unique_lock<std::mutex>& lock) {
  lock.unlock();
  publish();
  lock.lock();
}

/// Publishes a snapshot without copying anything from the mapper.
void Replay::publish_as_it_is() {
  auto snapshot = maker_->snapshot(phase_);
  const std::lock_guard lock(snapshot_mutex_);
  snapshot_ = std::move(snapshot);
}

/// Reports the requests to save or export that the run ended without serving.
void Replay::refuse_requests() {
  const std::lock_guard lock(mutex_);
  const auto refusal = [](int number, const std::filesystem::path& path) {
    const std::string failure =
        path.string() + " was not written: the run ended first. Map the log again and repeat the command.";
    return WriteOutcome{number, path, failure, "", {}};
  };
  if (save_) maker_->note_save(refusal(++saves_, *save_));
  if (export_) maker_->note_export(refusal(++exports_, export_->folder));
  publish_as_it_is();
}

}  // namespace psi_slam
