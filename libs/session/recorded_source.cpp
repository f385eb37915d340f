// SPDX-License-Identifier: BSD-3-Clause
#include "session/recorded_source.h"

#include <utility>

#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

double share_of(std::size_t done, std::size_t all) {
  return all == 0 ? 1 : static_cast<double>(done) / static_cast<double>(all);
}

}  // namespace

std::optional<Frame> RecordedSource::next() {
  const std::vector<Frame>& frames = recording_->frames;
  if (next_ < frames.size()) {
    if (log_) pass_by_recorded();
    return frames[next_++];
  }
  if (!log_) {
    if (const auto& broken_off = recording_->facts.logs.back().broken_off) throw UserError(*broken_off);
    return std::nullopt;
  }
  std::optional<Frame> frame = log_->next();
  if (frame) frame->index = next_++;
  return frame;
}

// Reads the log along with its recorded frames, so that its progress and skipped lines are right.
void RecordedSource::pass_by_recorded() {
  const std::size_t of_logs_before = recording_->frames.size() - recording_->facts.logs.back().scans;
  if (next_ >= of_logs_before && !log_->next())
    throw UserError(path_.string() + " holds fewer scans than the session recorded from it");
}

double RecordedSource::progress() const {
  if (!log_) return share_of(next_, recording_->frames.size());
  return log_->progress();
}

SkippedLines RecordedSource::skipped_lines() const {
  return log_ ? log_->skipped_lines() : recording_->facts.logs.back().skipped;
}

AppendedSource::AppendedSource(std::shared_ptr<const SessionRecording> recording,
                               std::unique_ptr<FrameSource> log, const std::filesystem::path& path)
    : recording_(std::move(recording)), log_(std::move(log)), first_(log_->next()) {
  const std::vector<Frame>& frames = recording_->frames;
  const char* const other = recording_->facts.logs.back().sha256.empty()
                                ? " cannot be compared with the log of the session (which was unreadable "
                                  "when it was saved) and does "
                                  "not continue it: its first scan is at "
                                : " is not the log of the session (their checksums differ) and does not "
                                  "continue it: its first scan "
                                  "is at ";
  if (first_ && !frames.empty() && first_->time_us <= frames.back().time_us)
    throw UserError(path.string() + other + format_seconds(first_->time_us) +
                    " s, the session's last scan at " + format_seconds(frames.back().time_us) + " s");
}

std::optional<Frame> AppendedSource::next() {
  if (next_ < recording_->frames.size()) return recording_->frames[next_++];
  std::optional<Frame> frame = first_ ? std::exchange(first_, std::nullopt) : log_->next();
  if (frame) frame->index = next_++;
  return frame;
}

// The length of the log is unknown, so the recording counts as half of all.
double AppendedSource::progress() const {
  const std::size_t recorded = recording_->frames.size();
  return next_ < recorded ? 0.5 * share_of(next_, recorded) : 0.5 + 0.5 * log_->progress();
}

}  // namespace psi_slam
