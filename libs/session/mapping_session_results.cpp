// SPDX-License-Identifier: BSD-3-Clause
// Exports the map and saves the session.
#include <algorithm>
#include <mutex>
#include <utility>

#include "base/file_checksum.h"
#include "base/worker_pool.h"
#include "logs/frames/discarded_ranges.h"
#include "map/exports/map_files.h"
#include "map/exports/mapped_trajectory.h"
#include "map/exports/zone_files.h"
#include "map/rendering/placed_edits.h"
#include "map/report/output_folder.h"
#include "psi_slam/grid_map.h"
#include "psi_slam/user_error.h"
#include "psi_slam/version.h"
#include "session/drawn_map.h"
#include "session/map_frame.h"
#include "session/mapping_session_members.h"
#include "session/session_file.h"
#include "session/session_input.h"
#include "session/work_clock.h"

namespace psi_slam {

namespace fs = std::filesystem;

namespace {

/// Limits the facts to the first `scans` scans. Scans that are not of an earlier log belong to the last log.
/// Drops logs and runs that begin later, and the edits of their scans.
void keep_first(std::size_t scans, SessionFacts& facts) {
  std::size_t left = scans;
  for (std::size_t i = 0; i < facts.logs.size(); ++i) {
    RecordedLog& log = facts.logs[i];
    const std::size_t taken = i + 1 < facts.logs.size() ? std::min(log.scans, left) : left;
    if (taken < log.scans) {
      log.broken_off.reset();
      log.scans_left = true;
    }
    log.scans = taken;
    left -= log.scans;
    if (left == 0) facts.logs.resize(i + 1);
  }
  const auto lost = std::find_if(facts.runs.begin(), facts.runs.end(),
                                 [&](const RecordedRun& run) { return run.scan >= scans; });
  if (lost == facts.runs.end()) return;
  const EditJournal edits = std::exchange(facts.edits, {});
  for (const TimedEdit& edit : edits.edits())
    if (edit.edit.frame < lost->scan) facts.edits.add(edit);
  for (const MapEdit& edit : edits.map_edits())
    if (edit.scan < lost->scan) facts.edits.add(edit);
  facts.edits.add(edits.knowledge());
  facts.runs.erase(lost, facts.runs.end());
}

/// Measures the time of one stage whose tasks several threads share.
class SharedStageClock {
 public:
  /// Appends `files` to `tasks`. The tasks add their times to timing(), and refer to this clock.
  void append(const Tasks& files, Tasks& tasks) {
    for (const auto& file : files)
      tasks.emplace_back([this, file] {
        const double ms = StageClock("write one file").time(file);
        const std::lock_guard<std::mutex> lock(mutex_);
        clock_.add(ms);
      });
  }
  StageTiming timing() const { return clock_.timing(); }

 private:
  std::mutex mutex_;  // guards clock_
  StageClock clock_{"write results"};
};

}  // namespace

DrawnMap MappingSession::draw_and_write(const OutputFolder* folder) {
  Members& m = *m_;
  m.begin(SessionProgress::Phase::kWriting);
  WorkClock clock(m.work_s);
  m.result.stages.resize(m.stages_of_mapping);
  StageClock drawing_clock("draw map");
  StageClock judging_clock("judge map");
  SharedStageClock writing_clock;
  const mrpt::math::TPose2D export_T_mapper = export_T_map(m.result, m.settings.map_frame);
  const mrpt::math::TPose2D map_T_start = export_T_start(m.result, m.settings.map_frame);
  const EditJournal edits = m.edits.with_frames(map_T_start);
  const PlacedMapEdits placed = placed_edits(edits.map_edits(), export_T_mapper, [&](std::size_t scan) {
    return scan < m.result.frames.size() ? std::optional(m.result.frames[scan].map_T_robot) : std::nullopt;
  });
  const ExportedPoses exported(m.result, export_T_mapper);
  mrpt::maps::COccupancyGridMap2D::Ptr grid;
  std::vector<std::string> contradictions;
  bool is_extended = false;
  const auto draw_map = [&] {
    grid = draw_grid_map(m.result.log, mapped_poses(m.result), m.settings.map);
    if (m.prior)
      for (std::string& sentence : m.prior->compare(*grid)) contradictions.push_back(std::move(sentence));
    is_extended = m.prior && m.prior->extends(*grid);
    if (is_extended) grid = m.prior->extended(*grid);
    m.map_edit_complaints = apply_map_edits(placed.edits, *grid);
  };
  std::vector<Frame> room;
  const std::vector<Frame>& whole = m.whole_log(room, contradictions);
  Tasks before_grid = {[&] { drawing_clock.time(draw_map); },
                       [&] { judging_clock.time([&] { m.verdict = judge_map(m.result); }); },
                       [&] { m.check_log(whole); }};
  if (folder) {
    writing_clock.append(path_file_tasks(m.result, whole, *folder, m.settings.map_files), before_grid);
    if (!edits.empty())
      writing_clock.append({[&] { edits.write(folder->path() / "loops.edits"); }}, before_grid);
  }
  WorkerPool pool(worker_threads(m.settings.run));
  pool.run(before_grid);
  m.result.contradictions.resize(m.contradictions_of_mapping);
  for (std::string& sentence : contradictions) m.result.contradictions.push_back(std::move(sentence));
  for (const MapEdit& edit : placed.without_place)
    m.map_edit_complaints.push_back(text_of(edit) + ": its scan " + std::to_string(edit.scan) +
                                    " is not mapped, the last scan is " +
                                    std::to_string(m.result.frames.size() - 1));
  m.result.stages.push_back(drawing_clock.timing());
  m.result.stages.push_back(judging_clock.timing());
  if (folder) {
    Tasks after_grid;
    writing_clock.append(map_file_tasks(folder->path(), m.result, *grid, placed.edits, m.settings.map_files),
                         after_grid);
    writing_clock.append({[&] { write_zone_files(folder->path(), *grid, placed.edits); }}, after_grid);
    pool.run(after_grid);
    m.result.stages.push_back(writing_clock.timing());
  }
  clock.stop();
  m.result.wall_s = m.work_s;
  RunSummary summary = summarize_run(m.result, *grid, m.settings.map);
  summary.map.map_T_start = map_T_start;
  summary.verdict = m.verdict;
  if (m.prior) summary.prior = m.prior->fit();
  if (summary.prior) summary.prior->is_extended = is_extended;
  summary.log.spare_scans = skipped_lines().spare_scans;
  if (folder) export_account(m.result, run_info(), summary, *grid, *folder);
  return {std::move(grid), std::move(summary)};
}

RunSummary MappingSession::export_to(const OutputFolder& folder) {
  check_prior_apart(m_->settings, folder.path());
  RunSummary summary;
  folder.replace_results(
      [&](const OutputFolder& temporary) { summary = draw_and_write(&temporary).summary; });
  return summary;
}

DrawnMap MappingSession::draw() {
  return draw_and_write(nullptr);
}

void MappingSession::read_exported(const std::function<void(const MappingResult&)>& read) {
  const ExportedPoses exported(m_->result, export_T_map(m_->result, m_->settings.map_frame));
  read(m_->result);
}

void MappingSession::export_to(const fs::path& folder, bool force) {
  export_to(OutputFolder::prepare(folder, force, "force = true"));
}

/// Frames to save: those that were mapped, as the mapper received them, or all of the recording. `room` holds
/// them if the mapper has changed some.
const std::vector<Frame>& MappingSession::Members::recorded_frames(std::vector<Frame>& room) const {
  const std::vector<Frame>& mapped = mapped_log();
  if (recording && mapped.size() < recording->frames.size()) return recording->frames;
  if (bent.empty() && superseded.empty()) return mapped;
  room = mapped;
  superseded.put_back(room);
  for (const auto& [number, frame] : bent)
    if (has_ranges(room.at(number))) room[number] = frame;
  return room;
}

/// Scans of the finished map, with the ranges of superseded scans. `room` holds them if there are any.
const std::vector<Frame>& MappingSession::Members::whole_log(std::vector<Frame>& room,
                                                             std::vector<std::string>& complaints) const {
  if (superseded.empty()) return result.log;
  room = result.log;
  try {
    superseded.put_back(room);
  } catch (const SystemFailure& failure) {
    complaints.push_back(std::string("the corrected log lacks scans of earlier passes: ") + failure.what());
  }
  return room;
}

SavedSession MappingSession::save(const fs::path& file) const {
  std::vector<Frame> room;
  const std::vector<Frame>& frames = m_->recorded_frames(room);
  const SessionFacts facts = m_->facts();
  write_session_file(file, facts, frames);
  SavedSession saved{frames.size(), ""};
  if (facts.logs.back().sha256.empty() && !m_->log_path.empty())
    saved.remark = "The session holds all scans that were mapped, but " + facts.logs.back().name +
                   " is no longer readable or became shorter, so the session cannot be resumed from it";
  return saved;
}

void MappingSession::start_journal(const fs::path& file) {
  static const std::vector<Frame> no_frames;
  m_->journal =
      std::make_unique<SessionJournal>(file, m_->facts(), m_->recording ? m_->recording->frames : no_frames,
                                       m_->settings.live.journal_period_s);
}

void MappingSession::remove_journal() {
  if (m_->journal) m_->journal->remove();
  m_->journal.reset();
}

std::optional<std::string> MappingSession::journal_failure() const {
  return m_->journal ? m_->journal->failure() : std::nullopt;
}

void MappingSession::Members::update_journal() const {
  if (journal) journal->update(facts());
}

SessionFacts MappingSession::Members::facts() const {
  SessionFacts facts;
  const bool is_replaying = recording && scans < recording->frames.size();
  facts.program_version = PSI_SLAM_VERSION;
  facts.logs = is_replaying ? recording->facts.logs : logs;
  facts.runs = later_runs;
  facts.settings = settings_text;
  if (prior) facts.prior = prior->recorded();
  // Without their frames, edits could lie beside their walls when the session is resumed.
  const bool states_frames = state == State::kFinished && !edits.map_edits().empty();
  facts.edits = states_frames ? edits.with_frames(export_T_start(result, settings.map_frame)) : edits;
  if (is_replaying) return facts;
  keep_first(scans, facts);
  if (facts.logs.size() < logs.size()) return facts;
  RecordedLog& last = facts.logs.back();
  if (last.sha256.empty()) last.sha256 = checksum_of_log();
  last.skipped = source->skipped_lines();
  last.assumptions = source->assumptions();
  last.broken_off = broken_off;
  last.scans_left = logs.back().scans_left || state == State::kReading;
  return facts;
}

std::string MappingSession::Members::checksum_of_log() const {
  if (!log_sha256.empty()) return log_sha256;
  std::error_code ignored;
  if (!fs::is_regular_file(log_path, ignored) && !fs::is_directory(log_path, ignored)) return "";
  try {
    log_sha256 = sha256_of_log(log_path);
  } catch (const UserError&) {
  } catch (const fs::filesystem_error&) {  // the log is a folder
  }
  if (bytes_on_disk(log_path) < log_bytes) log_sha256.clear();  // it is not the log that was read
  return log_sha256;
}

}  // namespace psi_slam
