// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/mapping_session.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <map>
#include <stdexcept>
#include <utility>

#include "base/file_checksum.h"
#include "doctor/quick_check.h"
#include "exports/interruptions.h"
#include "exports/unmatched_scans.h"
#include "frames/discarded_ranges.h"
#include "frames/log_reader.h"
#include "pose_graph/g2o_file.h"
#include "psi_slam/configuration.h"
#include "psi_slam/frame_source.h"
#include "psi_slam/grid_map.h"
#include "psi_slam/user_error.h"
#include "psi_slam/version.h"
#include "report/output_folder.h"
#include "session/session_file.h"
#include "session/session_input.h"
#include "session/settings.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

bool has_return(const Frame& frame) {
  bool any = false;
  for_each_scan(frame, {}, [&](const LaserScan& scan, const mrpt::math::TPose2D&) {
    any = any || std::any_of(scan.ranges_m.begin(), scan.ranges_m.end(),
                             [](float range_m) { return std::isfinite(range_m); });
  });
  return any;
}

bool has_sweep(const Frame& frame) {
  return frame.scan.sweep_time_s != 0 ||
         std::any_of(frame.companions.begin(), frame.companions.end(),
                     [](const CompanionScan& companion) { return companion.scan.sweep_time_s != 0; });
}

/// Adds the time from its construction to its destruction to `work_s`, in seconds.
class WorkClock {
 public:
  explicit WorkClock(double& work_s) : work_s_(work_s), before_s_(work_s) {}
  ~WorkClock() { stop(); }
  WorkClock(const WorkClock&) = delete;
  WorkClock& operator=(const WorkClock&) = delete;

  void stop() {
    work_s_ = before_s_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  /// Continues after stop(). The time between stop() and resume() does not count.
  void resume() {
    before_s_ = work_s_;
    start_ = std::chrono::steady_clock::now();
  }

 private:
  double& work_s_;
  double before_s_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

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
  facts.runs.erase(lost, facts.runs.end());
}

}  // namespace

struct MappingSession::Members {
  enum class State {
    kReading,   ///< the log may have more scans
    kRead,      ///< all scans are taken: the log ended, is damaged, or finish() was called
    kFinished,  ///< the map is finished
  };

  /// Changes the state. Allowed: kReading -> kRead when the log ends and in finish(), kRead -> kFinished in
  /// finish(), kFinished -> kRead in reopen(), kRead -> kReading in begin_run(). Other transitions throw
  /// std::logic_error.
  void enter(State next);
  std::optional<Frame> read();
  void keep_bent(const Frame& frame);
  const std::vector<Frame>& recorded_frames(std::vector<Frame>& room) const;
  void check_log();
  void make_due_edits(EditTime now);
  void begin_recorded_run();
  SessionFacts facts() const;
  const std::vector<Frame>& mapped_log() const {
    return state == State::kFinished ? result.log : mapper->log();
  }
  /// SHA-256 of the log; empty if the log is no longer readable.
  std::string checksum_of_log() const;
  void write_edits(const fs::path& file) const;
  void begin(SessionProgress::Phase new_phase);
  void report(double share) const;

  std::shared_ptr<const SessionRecording> recording;  ///< null if there is no recorded session
  fs::path log_path;                                  ///< the log that is read; empty if there is none
  mutable std::string log_sha256;                     ///< cache of checksum_of_log()
  /// For the last log, scans_left means that readable scans are known to remain.
  std::vector<RecordedLog> logs;
  std::vector<RecordedRun> later_runs;
  Settings settings;
  std::vector<std::string> settings_warnings;
  std::unique_ptr<FrameSource> source;
  /// Frames without odometry as the log states them, by their numbers. The mapper removes the motion during
  /// the sweep from its own copies. Lacks frames whose ranges the mapper has discarded, except recent ones.
  std::map<std::size_t, Frame> bent;
  std::size_t most_bent = 1000;    ///< number of entries of `bent` at which discarded frames are looked for
  std::unique_ptr<Mapper> mapper;  ///< null after finish() without stay_open()
  Mapper::AfterFinish after_finish = Mapper::AfterFinish::kNothing;
  EditJournal edits;
  std::vector<std::string> edit_complaints;
  Observer observer;
  State state = State::kReading;
  MappingResult result;
  std::optional<std::string> broken_off;
  std::vector<std::string> faults;  ///< see faults_of_log()
  std::size_t scans_checked = 0;    ///< number of scans for which `faults` was determined
  StageClock reading_clock{"read log"};
  SessionProgress::Phase phase = SessionProgress::Phase::kMapping;
  double phase_began_s = 0;  ///< value of work_s when the phase began
  double work_s = 0;         ///< time of work, without pauses between calls
  std::size_t scans = 0;
  std::size_t stages_of_mapping = 0;  ///< number of entries of result.stages that precede those of the export
};

MappingSession::MappingSession(const fs::path& log, const Configuration& configuration)
    : MappingSession(SessionInput(log), configuration, configuration.warnings()) {}

MappingSession::MappingSession(const fs::path& log, const Settings& settings)
    : MappingSession(SessionInput(log), settings) {}

MappingSession::MappingSession(const SessionInput& input, const Settings& settings,
                               std::vector<std::string> settings_warnings)
    : m_(std::make_unique<Members>()) {
  m_->recording = input.recording();
  m_->log_path = input.log();
  m_->logs = input.logs();
  m_->settings = settings;
  m_->settings_warnings = std::move(settings_warnings);
  m_->source = open_input(input, settings);
  m_->mapper = std::make_unique<Mapper>(mapper_options(settings));
  m_->edits = input.edits();
  m_->make_due_edits({});
  if (m_->recording) m_->later_runs = m_->recording->facts.runs;
}

MappingSession::~MappingSession() = default;

void MappingSession::Members::enter(State next) {
  const bool allowed = state == State::kRead ? next != State::kRead : next == State::kRead;
  if (!allowed) throw std::logic_error("MappingSession: its functions were called in a wrong order");
  state = next;
}

void MappingSession::set_observer(Observer observer) {
  m_->observer = std::move(observer);
}

bool MappingSession::step() {
  if (m_->state != Members::State::kReading) return false;
  {
    const WorkClock clock(m_->work_s);
    std::optional<Frame> frame = m_->read();
    if (!frame) return false;
    frame->index = m_->scans;
    m_->begin_recorded_run();
    m_->keep_bent(*frame);
    m_->mapper->add(*std::move(frame));
    m_->make_due_edits({EditTime::Kind::kAfterScan, m_->scans++});
  }
  m_->report(m_->source->progress());
  return true;
}

std::optional<Frame> MappingSession::Members::read() {
  std::optional<Frame> frame;
  try {
    reading_clock.time([&] { frame = source->next(); });
  } catch (const UserError& error) {
    if (scans == 0) throw;
    broken_off = error.what();
  }
  if (!frame) enter(State::kRead);
  return frame;
}

/// Keeps a frame as the log states it if the mapper may change it.
void MappingSession::Members::keep_bent(const Frame& frame) {
  if (frame.has_odometry || !has_sweep(frame)) return;
  bent.emplace(frame.index, frame);
  if (bent.size() < most_bent) return;
  for (auto kept = bent.begin(); kept != bent.end();) {
    const bool is_discarded = kept->first < scans && !has_ranges(mapper->log()[kept->first]);
    kept = is_discarded ? bent.erase(kept) : std::next(kept);
  }
  most_bent = 1000 + 2 * bent.size();
}

/// Checks each log of the result, unless the same scans were checked before.
void MappingSession::Members::check_log() {
  if (std::exchange(scans_checked, result.log.size()) == result.log.size()) return;
  faults.clear();
  for (const FrameSpan& of_log : logs_of(result))
    for (std::string& fault : quick_check(result.log, of_log.begin, of_log.end, log_options(settings)))
      if (std::find(faults.begin(), faults.end(), fault) == faults.end()) faults.push_back(std::move(fault));
}

void MappingSession::finish() {
  finish(std::atomic<bool>(false));
}

void MappingSession::finish(const std::atomic<bool>& stop) {
  Members& m = *m_;
  if (finished()) throw std::logic_error("MappingSession::finish: the map is already finished");
  m.begin(SessionProgress::Phase::kFinalSearch);
  WorkClock clock(m.work_s);
  if (std::none_of(m.mapper->log().begin(), m.mapper->log().end(), has_return))
    throw UserError((m.log_path.empty() ? names_of(m.logs) : m.log_path.string()) + ": " +
                    (m.scans == 0
                         ? "no scan was read, so there is nothing to map. Choose a log with 2D laser scans"
                         : "none of its " + std::to_string(m.scans) +
                               " scans has a return between log.min_range_m and log.max_range_m. "
                               "Correct these two options"));
  if (m.state == Members::State::kReading) {
    bool& scans_left = m.logs.back().scans_left;
    scans_left = scans_left || m.read().has_value();
    if (m.state == Members::State::kReading) m.enter(Members::State::kRead);
  }
  m.mapper->end_log();
  m.make_due_edits({EditTime::Kind::kEnd, 0});
  const auto progress = [&](double share) {
    const bool goes_on = !stop;
    clock.stop();
    m.report(share);  // the observer may pause the run
    clock.resume();
    return goes_on;
  };
  m.result = m.mapper->finish(progress, m.after_finish);
  m.check_log();
  m.enter(Members::State::kFinished);
  if (m.after_finish == Mapper::AfterFinish::kNothing) m.mapper.reset();
  m.result.stages.insert(m.result.stages.begin(), m.reading_clock.timing());
  m.result.interrupted =
      m.result.interrupted ||
      std::any_of(m.logs.begin(), m.logs.end(), [](const RecordedLog& log) { return log.scans_left; });
  m.result.broken_off = m.broken_off;
  m.stages_of_mapping = m.result.stages.size();
}

void MappingSession::run(const std::atomic<bool>& stop) {
  while (step() && !stop) {
  }
  finish(stop);
}

void MappingSession::stay_open() {
  m_->after_finish = Mapper::AfterFinish::kReopen;
}

bool MappingSession::finished() const {
  return m_->state == Members::State::kFinished;
}

void MappingSession::reopen() {
  if (!finished() || !m_->mapper)
    throw std::logic_error("MappingSession::reopen() needs stay_open() and finish()");
  m_->enter(Members::State::kRead);
  m_->mapper->reopen(std::move(m_->result));
}

void MappingSession::add_edits(const EditJournal& edits) {
  m_->edits.add(edits);
  m_->make_due_edits({});
}

void MappingSession::Members::make_due_edits(EditTime now) {
  for (const LoopEdit& edit : edits.take_due(now)) {
    const LoopEditOutcome outcome = mapper->edit(edit);
    if (outcome.state == LoopEditOutcome::State::kImpossible)
      edit_complaints.push_back(text_of(edit) + ": " + outcome.reason);
  }
}

LoopEditOutcome MappingSession::edit(const LoopEdit& edit) {
  const WorkClock clock(m_->work_s);
  if (!m_->mapper) throw std::logic_error("MappingSession::edit() after finish() needs stay_open()");
  if (finished()) {
    LoopEditOutcome outcome = m_->mapper->judge(edit, m_->result.frames);
    if (outcome.state == LoopEditOutcome::State::kImpossible) return outcome;
    reopen();
  }
  const bool at_end = m_->state == Members::State::kRead;
  if (at_end) m_->mapper->end_log();
  const bool changes_later = m_->edits.forget_later(edit);
  LoopEditOutcome outcome = m_->mapper->edit(edit);
  if (outcome.state == LoopEditOutcome::State::kImpossible)
    return changes_later ? LoopEditOutcome{} : outcome;
  EditTime now{EditTime::Kind::kBegin, 0};
  if (at_end)
    now.kind = EditTime::Kind::kEnd;
  else if (m_->scans > 0)
    now = {EditTime::Kind::kAfterScan, m_->scans - 1};
  m_->edits.enter({edit, now});
  return outcome;
}

void MappingSession::plan(const std::vector<TimedEdit>& edits) {
  const bool at_end = m_->state != Members::State::kReading;
  for (const TimedEdit& later : edits) {
    const bool passed = at_end || later.time < EditTime{EditTime::Kind::kAfterScan, m_->scans};
    if (passed)
      edit(later.edit);
    else
      m_->edits.add(later);
  }
}

const EditJournal& MappingSession::edits() const {
  return m_->edits;
}

std::size_t MappingSession::runs() const {
  return m_->later_runs.size() + 1;
}

void MappingSession::Members::begin_recorded_run() {
  for (const RecordedRun& run : later_runs) {
    if (run.scan != scans) continue;
    const std::size_t nodes = mapper->graph().num_nodes();
    if (run.start.node >= nodes)
      throw UserError("a recorded run begins at node " + std::to_string(run.start.node) +
                      " of a map that has only " + std::to_string(nodes) +
                      " nodes. The session was recorded with other settings: merge the logs again");
    mapper->begin_run(run.start);
  }
}

void MappingSession::begin_run(const SessionInput& run, const RunStart& start) {
  Members& m = *m_;
  auto source = open_input(run, m.settings);
  const std::vector<RecordedLog> logs_before = m.facts().logs;
  reopen();
  const std::size_t first_node = m.mapper->graph().num_nodes();
  m.later_runs.push_back({m.scans, start});
  const auto& inner = run.recording();
  if (inner)
    for (RecordedRun later : inner->facts.runs) {
      later.scan += m.scans;
      later.start.node += first_node;
      m.later_runs.push_back(later);
    }
  m.edits.add(
      run.edits().of_run(m.scans, inner ? inner->frames.size() : 0, m.mapper->keyframes().local_maps.size()));
  m.recording.reset();  // the recording no longer covers all logs
  m.log_path = run.log();
  m.log_sha256.clear();
  m.logs = logs_before;
  m.logs.insert(m.logs.end(), run.logs().begin(), run.logs().end());
  m.source = std::move(source);
  m.broken_off.reset();
  m.enter(Members::State::kReading);
  m.begin(SessionProgress::Phase::kMapping);
  m.make_due_edits({EditTime::Kind::kAfterScan, m.scans - 1});
}

RunSummary MappingSession::export_to(const OutputFolder& folder) {
  Members& m = *m_;
  m.begin(SessionProgress::Phase::kWriting);
  WorkClock clock(m.work_s);
  m.result.stages.resize(m.stages_of_mapping);
  StageClock drawing_clock("draw map");
  StageClock writing_clock("write results");
  mrpt::maps::COccupancyGridMap2D::Ptr grid;
  drawing_clock.time([&] { grid = draw_grid_map(m.result.log, mapped_poses(m.result), m.settings.map); });
  m.result.stages.push_back(drawing_clock.timing());
  writing_clock.time([&] {
    write_g2o(m.result.graph, folder.path() / "graph.g2o");
    m.write_edits(folder.path() / "loops.edits");
    export_results(m.result, *grid, folder, m.settings.map_files);
  });
  m.result.stages.push_back(writing_clock.timing());
  clock.stop();
  m.result.wall_s = m.work_s;
  RunSummary summary = summarize_run(m.result, *grid, m.settings.map);
  summary.log.spare_scans = skipped_lines().spare_scans;
  export_account(m.result, run_info(), summary, *grid, folder);
  return summary;
}

void MappingSession::export_to(const fs::path& folder, bool force) {
  export_to(OutputFolder::prepare(folder, force));
}

// Writes the edits, or removes the file of an earlier export if there are no edits.
void MappingSession::Members::write_edits(const fs::path& file) const {
  if (!edits.empty()) return edits.write(file);
  std::error_code ignored;
  fs::remove(file, ignored);
}

/// Frames to save: those that were mapped, as the mapper received them, or all of the recording. `room` holds
/// them if the mapper has changed some.
const std::vector<Frame>& MappingSession::Members::recorded_frames(std::vector<Frame>& room) const {
  const std::vector<Frame>& mapped = mapped_log();
  if (recording && mapped.size() < recording->frames.size()) return recording->frames;
  if (bent.empty()) return mapped;
  room = mapped;
  for (const auto& [number, frame] : bent)
    if (has_ranges(room.at(number))) room[number] = frame;
  return room;
}

SavedSession MappingSession::save(const fs::path& file) const {
  std::vector<Frame> room;
  const std::vector<Frame>& frames = m_->recorded_frames(room);
  const SessionFacts facts = m_->facts();
  write_session_file(file, facts, frames);
  SavedSession saved{frames.size(), ""};
  if (facts.logs.back().sha256.empty())
    saved.remark = "The session holds all scans that were mapped, but " + facts.logs.back().name +
                   " is no longer readable, so the session cannot be resumed from it";
  return saved;
}

SessionFacts MappingSession::Members::facts() const {
  SessionFacts facts;
  const bool is_replaying = recording && scans < recording->frames.size();
  facts.program_version = PSI_SLAM_VERSION;
  facts.logs = is_replaying ? recording->facts.logs : logs;
  facts.runs = later_runs;
  facts.settings = settings_file_text(settings);
  facts.edits = edits;
  if (is_replaying) return facts;
  keep_first(scans, facts);
  if (facts.logs.size() < logs.size()) return facts;
  RecordedLog& last = facts.logs.back();
  if (last.sha256.empty()) last.sha256 = checksum_of_log();
  last.skipped = source->skipped_lines();
  last.broken_off = broken_off;
  last.scans_left = logs.back().scans_left || state == State::kReading;
  return facts;
}

std::string MappingSession::Members::checksum_of_log() const {
  if (!log_sha256.empty()) return log_sha256;
  try {
    log_sha256 = sha256_of_log(log_path);
  } catch (const UserError&) {
  } catch (const fs::filesystem_error&) {  // the log is a folder
  }
  return log_sha256;
}

SkippedLines MappingSession::skipped_lines() const {
  SkippedLines skipped;
  for (auto before = m_->logs.begin(); before != m_->logs.end() - 1; ++before)
    skipped = skipped + before->skipped;
  return skipped + m_->source->skipped_lines();
}

const std::optional<std::string>& MappingSession::broken_off() const {
  return m_->broken_off;
}

bool MappingSession::breaks_off() const {
  return m_->broken_off || std::any_of(m_->logs.begin(), m_->logs.end() - 1, [](const RecordedLog& before) {
           return before.broken_off.has_value();
         });
}

std::vector<std::string> MappingSession::warnings_of_logs_before() const {
  std::vector<std::string> warnings;
  for (auto log = m_->logs.begin(); log != m_->logs.end() - 1; ++log) {
    if (log->broken_off)
      warnings.push_back(*log->broken_off + "; this run is mapped up to the damage");
    else if (log->scans_left)
      warnings.push_back("only the first " + std::to_string(log->scans) + " scans of " + log->name +
                         " are mapped: the run was interrupted and never resumed");
  }
  return warnings;
}

std::vector<std::string> MappingSession::unmet_edits() const {
  std::vector<std::string> unmet = m_->edit_complaints;
  unmet.insert(unmet.end(), m_->result.unmet_edits.begin(), m_->result.unmet_edits.end());
  return unmet;
}

std::vector<std::string> MappingSession::assumptions() const {
  std::vector<std::string> assumptions = m_->source->assumptions();
  const std::vector<Frame>& log = m_->mapped_log();
  const auto without = static_cast<std::size_t>(
      std::count_if(log.begin(), log.end(), [](const Frame& frame) { return !frame.has_odometry; }));
  const bool has_gyroscope = std::any_of(
      log.begin(), log.end(), [](const Frame& frame) { return frame.imu_heading_rad.has_value(); });
  if (without == log.size() && without > 0 && !ignores_odometry(log_options(m_->settings)))
    assumptions.push_back(
        std::string("the log has no odometry, so the motion between scans follows from the scans ") +
        (has_gyroscope ? "and the gyroscope" : "alone"));
  else if (without > 0 && without < log.size())
    assumptions.push_back(std::to_string(without) + " of " + std::to_string(log.size()) +
                          " scans have no odometry");
  return assumptions;
}

const std::vector<std::string>& MappingSession::faults_of_log() const {
  return m_->faults;
}

std::vector<std::string> MappingSession::warnings() const {
  std::vector<std::string> warnings = m_->settings_warnings;
  for (const std::string& warning : warnings_of_logs_before()) warnings.push_back(warning);
  if (m_->broken_off) warnings.push_back(*m_->broken_off);
  if (const SkippedLines skipped = skipped_lines(); skipped.count > 0) warnings.push_back(skipped.sentence());
  for (const std::string& assumption : assumptions()) warnings.push_back(assumption);
  for (const std::string& fault : faults_of_log()) warnings.push_back(fault);
  for (const std::string& complaint : unmet_edits()) warnings.push_back("an edit was not made: " + complaint);
  if (const auto unmatched = unmatched_scans_text(m_->result)) warnings.push_back(*unmatched);
  for (const std::string& interruption : interruption_texts(m_->result)) warnings.push_back(interruption);
  return warnings;
}

const Mapper& MappingSession::mapper() const {
  if (!m_->mapper) throw std::logic_error("MappingSession::mapper() after finish() needs stay_open()");
  return *m_->mapper;
}

const MappingResult& MappingSession::result() const {
  return m_->result;
}

RunInfo MappingSession::run_info() const {
  BoundSettings bound;
  bound.settings = m_->settings;
  RunInfo info{PSI_SLAM_VERSION, names_of(m_->logs), {}, {}};
  for (const OptionSection& section : bound.table.sections())
    for (const Option& option : section.options) info.settings[option.name()] = option.text();
  info.warnings = warnings();
  return info;
}

void MappingSession::Members::begin(SessionProgress::Phase new_phase) {
  phase = new_phase;
  phase_began_s = work_s;
  report(0);
}

void MappingSession::Members::report(double share) const {
  if (!observer) return;
  const double scans_per_s = work_s > 0 ? static_cast<double>(scans) / work_s : 0;
  SessionProgress progress{phase, share, scans, scans_per_s, work_s, {}};
  if (share > 0) progress.remaining_s = (work_s - phase_began_s) * (1 - share) / share;
  observer(progress);
}

}  // namespace psi_slam
