// SPDX-License-Identifier: BSD-3-Clause
// What a session is made of, recorded or read: saved, and gone on with in another drive.
#include <algorithm>
#include <string>
#include <utility>

#include "session/open_input.h"
#include "base/file_checksum.h"
#include "psi_slam/user_error.h"
#include "session/bound_settings.h"
#include "psi_slam/mapping_session.h"
#include "session/session_file.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

EditJournal edits_before(std::size_t scan, const EditJournal& edits) {
  EditJournal before;
  for (const TimedEdit& edit : edits.edits())
    if (edit.edit.frame < scan) before.add(edit);
  return before;
}

/// The last log has all scans that those before do not have. A recorded drive that was interrupted has logs
/// and further drives that were not reached: they are left out, and the edits of their scans.
void cut_behind(std::size_t scans, SessionFacts& facts) {
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
                                 [&](const RecordedRun& drive) { return drive.scan >= scans; });
  if (lost == facts.runs.end()) return;
  facts.edits = edits_before(lost->scan, facts.edits);
  facts.runs.erase(lost, facts.runs.end());
}

}  // namespace

SavedSession MappingSession::save(const std::filesystem::path& file) const {
  const std::vector<Frame>& mapped = finished_ ? result_.log : mapper_->log();
  const bool all_of_recording = !recording_ || mapped.size() >= recording_->frames.size();
  const std::vector<Frame>& frames = all_of_recording ? mapped : recording_->frames;
  const SessionFacts all = facts();
  write_session_file(file, all, frames);
  SavedSession saved{frames.size(), ""};
  if (all.logs.back().sha256.empty())
    saved.remark = "The session holds all scans that were mapped, but " + all.logs.back().name +
                   " could not be read any more: it cannot be gone on with in it";
  return saved;
}

SessionFacts MappingSession::facts() const {
  SessionFacts facts;
  const bool recording_goes_on = recording_ && scans_ < recording_->frames.size();
  if (recording_goes_on)
    facts = recording_->facts;
  else
    facts.logs = logs_;
  facts.runs = runs_;
  facts.edits = edits_;
  if (!recording_goes_on) {
    cut_behind(scans_, facts);
    RecordedLog& last = facts.logs.back();
    if (facts.logs.size() == logs_.size()) {
      if (last.sha256.empty()) last.sha256 = checksum_of_log();
      last.skipped = source_->skipped_lines();
      last.broken_off = broken_off_;
      last.scans_left = scans_left_ || (!at_end_ && !broken_off_);
    }
  }
  facts.program_version = PSI_SLAM_VERSION;
  facts.settings = settings_file_text(settings_);
  return facts;
}

// A log that is gone is no reason to lose what was read of it.
std::string MappingSession::checksum_of_log() const {
  if (!log_sha256_.empty()) return log_sha256_;
  try {
    log_sha256_ = sha256_of_log(path_);
  } catch (const UserError&) {
  } catch (const fs::filesystem_error&) {  // of a folder
  }
  return log_sha256_;
}

void MappingSession::begin_recorded_run() {
  for (const RecordedRun& drive : runs_) {
    if (drive.scan != scans_) continue;
    if (drive.start.node >= mapper_->graph().num_nodes())
      throw UserError("a recorded drive begins at node " + std::to_string(drive.start.node) +
                      " of a map that has " + std::to_string(mapper_->graph().num_nodes()) +
                      ": it was recorded with other settings, merge the logs anew");
    mapper_->begin_run(drive.start);
  }
}

void MappingSession::begin_run(const SessionInput& drive, const RunStart& start) {
  auto source = open_input(drive, settings_);
  const std::vector<RecordedLog> logs_before = facts().logs;
  reopen();
  const std::size_t first_node = mapper_->graph().num_nodes();
  runs_.push_back({scans_, start});
  const auto& inner = drive.recording();
  if (inner)
    for (RecordedRun later : inner->facts.runs) {
      later.scan += scans_;
      later.start.node += first_node;
      runs_.push_back(later);
    }
  edits_.add(
      drive.edits().of_drive(scans_, inner ? inner->frames.size() : 0, mapper_->keyframes().local_maps.size()));
  recording_.reset();  // it is no longer all that there is
  path_ = drive.log();
  log_sha256_.clear();
  logs_ = logs_before;
  logs_.insert(logs_.end(), drive.logs().begin(), drive.logs().end());
  source_ = std::move(source);
  broken_off_.reset();
  at_end_ = false;
  scans_left_ = inner != nullptr && path_.empty() && inner->facts.logs.back().scans_left;
  begin(SessionProgress::Phase::kMapping);
  make_due_edits({EditTime::Kind::kAfterScan, scans_ - 1});
}

SkippedLines MappingSession::skipped_lines() const {
  SkippedLines skipped;
  for (auto before = logs_.begin(); before != logs_.end() - 1; ++before) skipped = skipped + before->skipped;
  return skipped + source_->skipped_lines();
}

std::vector<std::string> MappingSession::warnings_of_logs_before() const {
  std::vector<std::string> warnings;
  for (auto log = logs_.begin(); log != logs_.end() - 1; ++log) {
    if (log->broken_off)
      warnings.push_back(*log->broken_off + "; this drive is mapped up to there");
    else if (log->scans_left)
      warnings.push_back("only the first " + std::to_string(log->scans) + " scans of " + log->name +
                         " are mapped: it was interrupted and not gone on with");
  }
  return warnings;
}

bool MappingSession::breaks_off() const {
  return broken_off_ || std::any_of(logs_.begin(), logs_.end() - 1,
                                    [](const RecordedLog& before) { return before.broken_off.has_value(); });
}

}  // namespace psi_slam
