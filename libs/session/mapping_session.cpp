// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/mapping_session.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "session/open_input.h"
#include "psi_slam/user_error.h"
#include "pose_graph/g2o_file.h"
#include "psi_slam/grid_map.h"
#include "session/bound_settings.h"

namespace psi_slam {
namespace {

bool has_return(const Frame& frame) {
  bool any = false;
  for_each_scan(frame, {}, [&](const LaserScan& scan, const mrpt::math::TPose2D&) {
    any = any || std::any_of(scan.ranges_m.begin(), scan.ranges_m.end(),
                             [](float range_m) { return std::isfinite(range_m); });
  });
  return any;
}

}  // namespace

/// Adds the time of its scope to the session's work.
class MappingSession::WorkClock {
 public:
  explicit WorkClock(double& work_s) : work_s_(work_s), before_s_(work_s) {}
  ~WorkClock() { stop(); }
  WorkClock(const WorkClock&) = delete;
  WorkClock& operator=(const WorkClock&) = delete;

  /// Brings the work up to now.
  void stop() {
    work_s_ = before_s_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  /// What came since stop() was no work.
  void go_on() {
    before_s_ = work_s_;
    start_ = std::chrono::steady_clock::now();
  }

 private:
  double& work_s_;
  double before_s_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

MappingSession::MappingSession(const std::filesystem::path& log, const Settings& settings)
    : MappingSession(SessionInput(log), settings) {}

MappingSession::MappingSession(const SessionInput& input, const Settings& settings)
    : recording_(input.recording()),
      path_(input.log()),
      logs_(input.logs()),
      settings_(settings),
      source_(open_input(input, settings)),
      mapper_(std::make_unique<Mapper>(mapper_options(settings))),
      edits_(input.edits()) {
  make_due_edits({});
  if (!recording_) return;
  runs_ = recording_->facts.runs;
  scans_left_ = path_.empty() && recording_->facts.logs.back().scans_left;
}

MappingSession::~MappingSession() = default;

bool MappingSession::step() {
  if (at_end_ || broken_off_) return false;
  {
    const WorkClock clock(work_s_);
    std::optional<Frame> frame = read();
    if (!frame) return false;
    frame->index = scans_;
    any_return_ = any_return_ || has_return(*frame);
    begin_recorded_run();
    mapper_->add(*std::move(frame));
    make_due_edits({EditTime::Kind::kAfterScan, scans_++});
  }
  tell(source_->progress());
  return true;
}

std::optional<Frame> MappingSession::read() {
  std::optional<Frame> frame;
  try {
    reading_clock_.time([&] { frame = source_->next(); });
    at_end_ = !frame;
  } catch (const UserError& error) {
    if (scans_ == 0) throw;
    broken_off_ = error.what();
  }
  return frame;
}

void MappingSession::finish(const std::atomic<bool>& stop) {
  begin(SessionProgress::Phase::kFinalSearch);
  WorkClock clock(work_s_);
  if (!any_return_)
    throw UserError((path_.empty() ? names_of(logs_) : path_.string()) + ": " +
                    (scans_ == 0 ? "no scan was read, there is nothing to map"
                                 : "none of its " + std::to_string(scans_) +
                                       " scans has a return between log.min_range_m and log.max_range_m"));
  scans_left_ = scans_left_ || (!at_end_ && !broken_off_ && read().has_value());
  at_end_ = true;
  mapper_->end_log();
  make_due_edits({EditTime::Kind::kEnd, 0});
  result_ = mapper_->finish(
      [&](double share) {
        const bool go_on = !stop;
        clock.stop();
        tell(share);  // which may hold the run
        clock.go_on();
        return go_on;
      },
      stays_open_ ? Mapper::AfterFinish::kReopen : Mapper::AfterFinish::kNothing);
  finished_ = true;
  if (!stays_open_) mapper_.reset();
  result_.stages.insert(result_.stages.begin(), reading_clock_.timing());
  result_.interrupted = result_.interrupted || scans_left_ ||
                        std::any_of(logs_.begin(), logs_.end() - 1,
                                    [](const RecordedLog& before) { return before.scans_left; });
  result_.broken_off = broken_off_;
  stages_of_mapping_ = result_.stages.size();
}

void MappingSession::add_edits(const EditJournal& edits) {
  edits_.add(edits);
  make_due_edits({});
}

void MappingSession::make_due_edits(EditTime now) {
  for (const LoopEdit& edit : edits_.take_due(now)) {
    const LoopEditOutcome outcome = mapper_->edit(edit);
    if (outcome.state == LoopEditOutcome::State::kImpossible)
      edit_complaints_.push_back(text_of(edit) + ": " + outcome.reason);
  }
}

void MappingSession::reopen() {
  mapper_->reopen(std::move(result_));
  finished_ = false;
}

LoopEditOutcome MappingSession::edit(const LoopEdit& edit) {
  const WorkClock clock(work_s_);
  if (finished_) {
    LoopEditOutcome outcome = mapper_->judge(edit, result_.frames);
    if (outcome.state == LoopEditOutcome::State::kImpossible) return outcome;
    reopen();
  }
  const bool at_end = at_end_ || broken_off_;
  if (at_end) mapper_->end_log();
  const bool changes_later = edits_.forget_later(edit);
  LoopEditOutcome outcome = mapper_->edit(edit);
  if (outcome.state == LoopEditOutcome::State::kImpossible)
    return changes_later ? LoopEditOutcome{} : outcome;
  EditTime now{EditTime::Kind::kBegin, 0};
  if (at_end)
    now.kind = EditTime::Kind::kEnd;
  else if (scans_ > 0)
    now = {EditTime::Kind::kAfterScan, scans_ - 1};
  edits_.enter({edit, now});
  return outcome;
}

void MappingSession::plan(const std::vector<TimedEdit>& edits) {
  const bool at_end = finished_ || at_end_ || broken_off_.has_value();
  for (const TimedEdit& later : edits) {
    const bool passed = at_end || later.time < EditTime{EditTime::Kind::kAfterScan, scans_};
    if (passed)
      edit(later.edit);
    else
      edits_.add(later);
  }
}

void MappingSession::run(const std::atomic<bool>& stop) {
  while (step() && !stop) {
  }
  finish(stop);
}

RunSummary MappingSession::export_to(const OutputFolder& folder) {
  begin(SessionProgress::Phase::kWriting);
  WorkClock clock(work_s_);
  result_.stages.resize(stages_of_mapping_);
  StageClock drawing_clock("draw map");
  StageClock writing_clock("write results");
  mrpt::maps::COccupancyGridMap2D::Ptr grid;
  drawing_clock.time([&] { grid = draw_grid_map(result_.log, mapped_poses(result_), settings_.map); });
  result_.stages.push_back(drawing_clock.timing());
  writing_clock.time([&] {
    write_g2o(result_.graph, folder.path() / "graph.g2o");
    write_edits(folder.path() / "loops.edits");
    export_results(result_, *grid, folder, settings_.map_files);
  });
  result_.stages.push_back(writing_clock.timing());
  clock.stop();
  result_.wall_s = work_s_;
  RunSummary summary = summarize_run(result_, *grid, settings_.map);
  summary.log.spare_scans = skipped_lines().spare_scans;
  export_account(result_, run_info(), summary, *grid, folder);
  return summary;
}

// A folder without the file is one of a map without edits.
void MappingSession::write_edits(const std::filesystem::path& file) const {
  if (!edits_.empty()) return edits_.write(file);
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
}

std::vector<std::string> MappingSession::unmet_edits() const {
  std::vector<std::string> unmet = edit_complaints_;
  unmet.insert(unmet.end(), result_.unmet_edits.begin(), result_.unmet_edits.end());
  return unmet;
}

std::vector<std::string> MappingSession::warnings() const {
  std::vector<std::string> warnings = warnings_of_logs_before();
  if (broken_off_) warnings.push_back(*broken_off_);
  if (const SkippedLines skipped = skipped_lines(); skipped.count > 0) warnings.push_back(skipped.sentence());
  for (const std::string& complaint : unmet_edits()) warnings.push_back("an edit was not made: " + complaint);
  return warnings;
}

RunInfo MappingSession::run_info() const {
  BoundSettings bound;
  bound.settings = settings_;
  RunInfo info{PSI_SLAM_VERSION, names_of(logs_), {}, {}};
  for (const OptionSection& section : bound.table.sections())
    for (const Option& option : section.options) info.settings[option.name()] = option.text();
  info.warnings = warnings();
  return info;
}

void MappingSession::begin(SessionProgress::Phase phase) {
  phase_ = phase;
  phase_began_s_ = work_s_;
  tell(0);
}

void MappingSession::tell(double share) const {
  if (!observer_) return;
  SessionProgress progress;
  progress.phase = phase_;
  progress.share = share;
  progress.scans = scans_;
  progress.elapsed_s = work_s_;
  if (work_s_ > 0) progress.scans_per_s = static_cast<double>(scans_) / work_s_;
  if (share > 0) progress.remaining_s = (work_s_ - phase_began_s_) * (1 - share) / share;
  observer_(progress);
}

}  // namespace psi_slam
