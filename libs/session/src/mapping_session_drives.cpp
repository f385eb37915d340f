// SPDX-License-Identifier: BSD-3-Clause
// What a session is made of, recorded or read: saved, and gone on with in another drive.
#include <utility>

#include "open_input.h"
#include "psi_slam/base/file_checksum.h"
#include "psi_slam/session/bound_settings.h"
#include "psi_slam/session/mapping_session.h"
#include "psi_slam/session/session_file.h"

namespace psi_slam {

void MappingSession::save(const std::filesystem::path& file) const {
  const std::vector<Frame>& mapped = finished_ ? result_.log : mapper_->log();
  const bool all_of_recording = !recording_ || mapped.size() >= recording_->frames.size();
  write_session_file(file, facts(), all_of_recording ? mapped : recording_->frames);
}

SessionFacts MappingSession::facts() const {
  SessionFacts facts;
  if (recording_ && scans_ < recording_->frames.size()) {
    facts = recording_->facts;
  } else {
    facts.logs = logs_;
    RecordedLog& last = facts.logs.back();
    last.scans = scans_;
    for (std::size_t i = 0; i + 1 < facts.logs.size(); ++i) last.scans -= facts.logs[i].scans;
    if (last.sha256.empty()) last.sha256 = sha256_of_log(path_);
    facts.skipped = skipped_lines();
    facts.broken_off = broken_off_;
    facts.scans_left = scans_left_ || (!at_end_ && !broken_off_);
  }
  facts.program_version = PSI_SLAM_VERSION;
  facts.drives = drives_;
  facts.settings = settings_file_text(settings_);
  facts.edits = edits_;
  return facts;
}

void MappingSession::begin_recorded_drive() {
  for (const RecordedDrive& drive : drives_)
    if (drive.scan == scans_) mapper_->begin_drive(drive.start);
}

void MappingSession::begin_drive(const SessionInput& drive, const DriveStart& start) {
  auto source = open_input(drive, settings_);
  const std::vector<RecordedLog> logs_before = facts().logs;
  skipped_before_ = skipped_lines();
  if (broken_off_) warnings_before_.push_back(*broken_off_);
  reopen();
  const std::size_t first_node = mapper_->graph().num_nodes();
  drives_.push_back({scans_, start});
  const auto& inner = drive.recording();
  if (inner)
    for (RecordedDrive later : inner->facts.drives) {
      later.scan += scans_;
      later.start.node += first_node;
      drives_.push_back(later);
    }
  edits_.add(drive.edits().of_drive(scans_, inner ? inner->frames.size() : 0, mapper_->memory().local_maps.size()));
  recording_.reset();  // it is no longer all that there is
  path_ = drive.log();
  logs_ = logs_before;
  logs_.insert(logs_.end(), drive.logs().begin(), drive.logs().end());
  source_ = std::move(source);
  broken_off_.reset();
  at_end_ = false;
  scans_left_ = scans_left_ || (inner != nullptr && path_.empty() && inner->facts.scans_left);
  begin(SessionProgress::Phase::kMapping);
  make_due_edits({EditTime::Kind::kAfterScan, scans_ - 1});
}

SkippedLines MappingSession::skipped_lines() const {
  SkippedLines skipped = source_->skipped_lines();
  skipped.count += skipped_before_.count;
  if (skipped_before_.count > 0) skipped.first = skipped_before_.first;
  return skipped;
}

}  // namespace psi_slam
