// SPDX-License-Identifier: BSD-3-Clause
#include "session/session_input.h"

#include <algorithm>
#include <utility>

#include "base/file_checksum.h"
#include "exports/geo_tiff.h"
#include "psi_slam/open_log.h"
#include "psi_slam/user_error.h"
#include "session/read_ahead.h"
#include "session/recorded_source.h"
#include "session/session_file.h"
#include "session/settings.h"

namespace psi_slam {
namespace {

/// Name of the file or folder; "runs/" is called "runs".
std::string name_of(const std::filesystem::path& log) {
  return (log.has_filename() ? log : log.parent_path()).filename().string();
}

}  // namespace

SessionInput::SessionInput(std::filesystem::path log) : log_(std::move(log)), logs_{{name_of(log_), "", 0}} {}

SessionInput::SessionInput(std::shared_ptr<const SessionRecording> recording, std::filesystem::path log)
    : recording_(std::move(recording)),
      log_(std::move(log)),
      logs_(recording_->facts.logs),
      edits_(recording_->facts.edits) {
  edits_.rewind();
  if (log_.empty()) return;
  if (!std::filesystem::exists(log_)) throw UserError(log_.string() + " does not exist, expected a log file");
  const std::string sha256 = sha256_of_log(log_);
  same_log_ = logs_.back().sha256 == sha256;
  if (same_log_) {  // read from its beginning again, which finds its faults again
    logs_.back() = {logs_.back().name, sha256, logs_.back().scans};
    return;
  }
  if (std::any_of(logs_.begin(), logs_.end(),
                  [&](const RecordedLog& known) { return known.sha256 == sha256; }))
    throw UserError(log_.string() + " is already in the session, before " + logs_.back().name);
  logs_.push_back({name_of(log_), sha256, 0});
}

SessionInput SessionInput::of_file(const std::filesystem::path& path) {
  if (!is_session_file(path)) return SessionInput(path);
  return SessionInput(std::make_shared<const SessionRecording>(read_session_file(path)));
}

SessionInput SessionInput::with_edits(EditJournal edits) const {
  SessionInput input = *this;
  input.edits_ = std::move(edits);
  input.edits_.rewind();
  return input;
}

std::unique_ptr<FrameSource> SessionInput::open(const LogOptions& options) const {
  if (!recording_) return open_log(log_, options);
  if (log_.empty()) return std::make_unique<RecordedSource>(recording_);
  const auto kind = same_log_ ? RecordedSource::Log::kLast : RecordedSource::Log::kNext;
  return std::make_unique<RecordedSource>(recording_, kind, open_log(log_, options), log_);
}

void check(const Settings& settings) {
  check_values(settings);
  check_epsg(settings.map_files.earth.epsg);
}

std::unique_ptr<FrameSource> open_input(const SessionInput& input, const Settings& settings) {
  check(settings);
  auto source = input.open(log_options(settings));
  if (worker_threads(settings.run) == 1) return source;
  return std::make_unique<ReadAhead>(std::move(source));
}

std::string names_of(const std::vector<RecordedLog>& logs) {
  std::string names;
  for (const RecordedLog& log : logs) names += (names.empty() ? "" : " + ") + log.name;
  return names;
}

}  // namespace psi_slam
