// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/mapping_session.h"

#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "base/scope_exit.h"
#include "logs/doctor/log_facts.h"
#include "logs/doctor/quick_check.h"
#include "logs/frames/discarded_ranges.h"
#include "map/exports/zone_files.h"
#include "map/verdict/gyroscope_check.h"
#include "psi_slam/configuration.h"
#include "psi_slam/frame_source.h"
#include "psi_slam/user_error.h"
#include "session/knowledge_line.h"
#include "session/map_frame.h"
#include "session/mapping_session_members.h"
#include "session/session_input.h"
#include "session/settings.h"
#include "session/work_clock.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

// Number of nodes that run() may be ahead of the back end. It bounds the memory of nodes and local maps that
// wait, and the time until run() stops.
constexpr std::size_t kRunAhead_nodes = 1000;

/// Returns the options of the mapper. The front end goes first, because several threads cannot share its
/// work. A live run has the threads beside it even with run.threads = 1.
MapperOptions options_for(const SessionInput& input, const Settings& settings) {
  MapperOptions options = mapper_options(settings);
  options.back_end.priority = ThreadPriority::kLow;
  options.back_end_thread = options.back_end_thread || input.is_stream();
  return options;
}

bool has_sweep(const Frame& frame) {
  return frame.scan.sweep_time_s != 0 ||
         std::any_of(frame.companions.begin(), frame.companions.end(),
                     [](const CompanionScan& companion) { return companion.scan.sweep_time_s != 0; });
}

}  // namespace

MappingSession::MappingSession(const fs::path& log, const Configuration& configuration)
    : MappingSession(SessionInput(log), configuration, configuration.warnings()) {}

MappingSession::MappingSession(const fs::path& log, const Settings& settings)
    : MappingSession(SessionInput(log), settings) {}

MappingSession::MappingSession(const SessionInput& input, const Settings& settings,
                               std::vector<std::string> settings_warnings)
    : m_(std::make_unique<Members>()) {
  m_->recording = input.recording();
  m_->log_path = input.log();
  m_->log_bytes = input.log_bytes();
  m_->logs = input.logs();
  m_->settings = settings;
  m_->settings_text = settings_file_text(settings);
  m_->settings_warnings = std::move(settings_warnings);
  m_->edits = input.edits();
  // Settings and edits are checked before the input is opened, because only its source can end a stream.
  check(settings);
  m_->check_knowledge({});
  if (!settings.prior.map.empty()) m_->prior.emplace(settings);
  if (m_->prior && m_->recording) m_->prior->compare_with(m_->recording->facts);
  m_->read_from(open_input(input, settings));
  m_->mapper = std::make_unique<Mapper>(options_for(input, settings));
  m_->mapper->set_superseded_observer(
      [members = m_.get()](std::size_t scan, const Frame& frame) { members->keep_superseded(scan, frame); });
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

void MappingSession::set_pose_observer(Mapper::PoseObserver observer) {
  if (!m_->mapper)
    throw std::logic_error("MappingSession::set_pose_observer() after finish() needs stay_open()");
  m_->mapper->set_pose_observer(std::move(observer));
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
    const bool is_recorded = m_->recording && m_->scans < m_->recording->frames.size();
    std::optional<Frame> to_journal;
    if (m_->journal && !is_recorded) to_journal = *frame;
    std::exception_ptr failure;
    try {
      m_->mapper->add(*std::move(frame));
    } catch (...) {  // if the observer of poses threw, the scan is mapped
      failure = std::current_exception();
    }
    if (m_->mapper->log().size() > m_->scans) {
      const std::size_t scan = m_->scans++;
      if (to_journal) m_->journal->add(*std::move(to_journal), m_->facts());
      m_->make_due_edits({EditTime::Kind::kAfterScan, scan});
    }
    if (failure) std::rethrow_exception(failure);
  }
  m_->report(m_->source->progress());
  return true;
}

bool MappingSession::scan_waits() const {
  return m_->state == Members::State::kReading && m_->source->is_ready();
}

void MappingSession::Members::read_from(OpenedInput opened) {
  source = std::move(opened.frames);
  logs.back().calibration = std::move(opened.calibration);
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

/// Keeps a scan that the mapper discards, as the log states it.
void MappingSession::Members::keep_superseded(std::size_t scan, const Frame& frame) {
  const auto stated = bent.find(scan);
  superseded.add(scan, stated == bent.end() ? frame : stated->second);
  if (stated != bent.end()) bent.erase(stated);
}

/// Checks each log of a finished map, unless the same scans were checked before. `log` has all scans with
/// their ranges.
void MappingSession::Members::check_log(const std::vector<Frame>& log) {
  if (!is_unchecked()) return;
  std::vector<std::string> all;
  for (const FrameSpan& of_log : logs_of(result)) {
    std::vector<std::string> found = quick_check(log, of_log.begin, of_log.end, log_options(settings));
    if (auto rejected = rejected_gyroscope(result, of_log)) found.push_back(*std::move(rejected));
    for (std::string& fault : found)
      if (std::find(all.begin(), all.end(), fault) == all.end()) all.push_back(std::move(fault));
  }
  faults = std::move(all);
  scans_checked = result.log.size();
}

void MappingSession::finish() {
  finish(std::atomic<bool>(false));
}

void MappingSession::finish(const std::atomic<bool>& stop) {
  Members& m = *m_;
  if (finished()) throw std::logic_error("MappingSession::finish: the map is already finished");
  WorkClock clock(m.work_s);
  std::exception_ptr failure;  // of the observer; thrown when the map is finished
  const auto off_the_clock = [&](const auto& report) {
    if (failure) return;
    clock.stop();  // the observer may pause the run
    try {
      report();
    } catch (...) {
      failure = std::current_exception();
    }
    clock.resume();
  };
  off_the_clock([&] {
    m.begin(m.prior ? SessionProgress::Phase::kPriorSearch : SessionProgress::Phase::kFinalSearch);
  });
  if (std::none_of(m.mapper->log().begin(), m.mapper->log().end(), has_return)) {
    const std::string log = m.log_path.empty() ? names_of(m.logs) : m.log_path.string();
    throw UserError(
        m.scans == 0
            ? log + ": no scan was read, so there is nothing to map. Choose a log with 2D laser scans"
            : no_returns_text(log, m.scans));
  }
  if (m.state == Members::State::kReading) {
    bool& scans_left = m.logs.back().scans_left;
    scans_left = scans_left || m.read().has_value();
    if (m.state == Members::State::kReading) m.enter(Members::State::kRead);
  }
  m.update_journal();
  m.mapper->end_log();
  m.make_due_edits({EditTime::Kind::kEnd, 0});
  const auto progress = [&](double share) {
    const bool goes_on = !stop;
    off_the_clock([&] { m.report(share); });
    return goes_on && !failure;
  };
  FixedKnowledge knowledge = m.edits.knowledge();
  std::optional<std::string> refusal;
  StageClock prior_clock("align with prior map");
  if (m.prior) {
    prior_clock.time([&] { refusal = m.prior->place(*m.mapper, knowledge, progress); });
    if (!m.prior->is_interrupted()) progress(1);
    off_the_clock([&] { m.begin(SessionProgress::Phase::kFinalSearch); });
  }
  m.mapper->set_knowledge(std::move(knowledge));
  m.result = m.mapper->finish(progress, m.after_finish);
  m.verdict.reset();
  if (m.prior && m.prior->changed_text()) m.result.contradictions.push_back(*m.prior->changed_text());
  if (refusal) m.result.contradictions.push_back(*std::move(refusal));
  m.contradictions_of_mapping = m.result.contradictions.size();
  m.enter(Members::State::kFinished);
  if (m.after_finish == Mapper::AfterFinish::kNothing) {
    m.mapper.reset();
#ifdef __GLIBC__
    malloc_trim(0);  // glibc would keep this memory, and drawing needs blocks that are too large for it
#endif
  }
  m.result.stages.insert(m.result.stages.begin(), m.reading_clock.timing());
  if (m.prior) m.result.stages.push_back(prior_clock.timing());
  m.result.interrupted =
      m.result.interrupted || (m.prior && m.prior->is_interrupted()) ||
      std::any_of(m.logs.begin(), m.logs.end(), [](const RecordedLog& log) { return log.scans_left; });
  m.result.broken_off = m.broken_off;
  m.stages_of_mapping = m.result.stages.size();
  if (failure) std::rethrow_exception(failure);
}

void MappingSession::run(const std::atomic<bool>& stop) {
  if (m_->mapper && worker_threads(m_->settings.run) > 1) m_->mapper->run_ahead(kRunAhead_nodes);
  const ScopeExit end([this] {
    if (m_->mapper) m_->mapper->run_ahead(std::nullopt);
  });
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
  EditJournal all = m_->edits;
  all.add(edits);
  check_zones(all.map_edits());
  m_->check_knowledge(edits);
  m_->edits = std::move(all);
  m_->make_due_edits({});
  m_->update_journal();
}

/// Throws UserError if the knowledge of these and further edits contradicts itself or the settings.
void MappingSession::Members::check_knowledge(const EditJournal& further) const {
  EditJournal all = edits;
  all.add(further);
  check_tags(all.knowledge());
  check_frame(settings.map_frame, all.knowledge());
  check_prior(settings, all.knowledge());
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
  if (outcome.state == LoopEditOutcome::State::kImpossible) {
    m_->update_journal();
    return changes_later ? LoopEditOutcome{} : outcome;
  }
  EditTime now{EditTime::Kind::kBegin, 0};
  if (at_end)
    now.kind = EditTime::Kind::kEnd;
  else if (m_->scans > 0)
    now = {EditTime::Kind::kAfterScan, m_->scans - 1};
  m_->edits.enter({edit, now});
  m_->update_journal();
  return outcome;
}

void MappingSession::edit(const MapEdit& edit) {
  std::vector<MapEdit> all = m_->edits.map_edits();
  all.push_back(edit);
  check_zones(all);
  m_->edits.add(edit);
  m_->update_journal();
}

void MappingSession::remove_last_map_edit() {
  m_->edits.remove_last_map_edit();
  m_->update_journal();
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
  m_->update_journal();
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
  m.check_knowledge(run.edits());
  OpenedInput opened = open_input(run, m.settings);
  const std::vector<RecordedLog> logs_before = m.facts().logs;
  reopen();
  const std::size_t first_node = m.mapper->graph().num_nodes();
  m.later_runs.push_back({m.scans, start});
  const auto& inner = run.recording();
  if (inner && m.prior) m.prior->compare_with(inner->facts);
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
  m.log_bytes = run.log_bytes();
  m.log_sha256.clear();
  m.logs = logs_before;
  m.logs.insert(m.logs.end(), run.logs().begin(), run.logs().end());
  m.read_from(std::move(opened));
  m.broken_off.reset();
  m.enter(Members::State::kReading);
  m.begin(SessionProgress::Phase::kMapping);
  m.make_due_edits({EditTime::Kind::kAfterScan, m.scans - 1});
}

const Mapper& MappingSession::mapper() const {
  if (!m_->mapper) throw std::logic_error("MappingSession::mapper() after finish() needs stay_open()");
  return *m_->mapper;
}

const MappingResult& MappingSession::result() const {
  return m_->result;
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
