// SPDX-License-Identifier: BSD-3-Clause
#include "session/recorded_source.h"

#include <utility>

#include "psi_slam/user_error.h"

namespace psi_slam {

RecordedSource::RecordedSource(std::shared_ptr<const SessionRecording> recording, Log kind,
                               std::unique_ptr<FrameSource> log, std::filesystem::path path)
    : recording_(std::move(recording)), kind_(kind), log_(std::move(log)), path_(std::move(path)) {
  if (kind_ == Log::kLast) return;
  first_ = log_->next();
  const std::vector<Frame>& frames = recording_->frames;
  if (!first_ || frames.empty() || first_->time_us > frames.back().time_us) return;
  const char* const why =
      recording_->facts.logs.back().sha256.empty()
          ? " cannot be compared with the log of the session (which was unreadable when it was saved)"
          : " is not the log of the session (their checksums differ)";
  throw UserError(path_.string() + why + " and does not continue it: its first scan is at " +
                  format_seconds(first_->time_us) + " s, the session's last scan at " +
                  format_seconds(frames.back().time_us) + " s");
}

std::optional<Frame> RecordedSource::next() {
  const std::vector<Frame>& frames = recording_->frames;
  if (next_ < frames.size()) {
    if (log_ && kind_ == Log::kLast) skip_recorded();
    return frames[next_++];
  }
  if (!log_) {
    if (const auto& broken_off = recording_->facts.logs.back().broken_off) throw UserError(*broken_off);
    return std::nullopt;
  }
  std::optional<Frame> frame = first_ ? std::exchange(first_, std::nullopt) : log_->next();
  if (frame) frame->index = next_++;
  return frame;
}

// Reads the log along with its recorded frames, so that its progress and skipped lines are right.
void RecordedSource::skip_recorded() {
  const std::size_t of_logs_before = recording_->frames.size() - recording_->facts.logs.back().scans;
  if (next_ >= of_logs_before && !log_->next())
    throw UserError(
        path_.string() +
        " holds fewer scans than the session recorded from it. Resume with the log that was recorded.");
}

// The length of the next log is unknown, so the recording counts as half of the total.
double RecordedSource::progress() const {
  if (log_ && kind_ == Log::kLast) return log_->progress();
  const std::size_t recorded = recording_->frames.size();
  const double share = recorded == 0 ? 1 : static_cast<double>(next_) / static_cast<double>(recorded);
  if (!log_) return share;
  return next_ < recorded ? 0.5 * share : 0.5 + 0.5 * log_->progress();
}

SkippedLines RecordedSource::skipped_lines() const {
  return log_ ? log_->skipped_lines() : recording_->facts.logs.back().skipped;
}

}  // namespace psi_slam
