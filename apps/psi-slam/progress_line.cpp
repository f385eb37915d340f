// SPDX-License-Identifier: BSD-3-Clause
#include "progress_line.h"

#include <mrpt/core/format.h>

#include <ostream>

#include "base/number_text.h"

namespace psi_slam {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kBetweenUpdates{200};
constexpr const char* kEraseLine = "\r\x1b[K";
constexpr double kEarlyShare = 0.01;  // share of the work below which an estimated time left is unreliable

}  // namespace

std::string progress_text(const SessionProgress& progress, bool of_stream) {
  using Phase = SessionProgress::Phase;
  const std::string scans = mrpt::format("%zu scans   %.0f scans/s", progress.scans, progress.scans_per_s);
  if (of_stream && progress.phase == Phase::kMapping) return scans;
  if (progress.phase == Phase::kWriting) return "drawing the map and writing the results";
  std::string line = mrpt::format("%3.0f %%   ", 100 * progress.share);
  if (progress.phase == Phase::kMapping)
    line += scans;
  else
    line += progress.phase == Phase::kPriorSearch ? "aligning with the prior map" : "final loop search";
  if (progress.remaining_s) line += "   " + minutes_text(*progress.remaining_s) + " left";
  return line;
}

std::string work_progress_text(const std::string& doing, double share, double elapsed_s) {
  std::string line = doing + mrpt::format("   %3.0f %%", 100 * share);
  if (share >= kEarlyShare) line += "   " + minutes_text(elapsed_s * (1 - share) / share) + " left";
  return line;
}

bool OverwrittenLine::is_due() const {
  return terminal_ != nullptr && (!shown_ || Clock::now() - shown_at_ >= kBetweenUpdates);
}

void OverwrittenLine::show(const std::string& text) {
  if (terminal_ == nullptr) return;
  shown_ = true;
  shown_at_ = Clock::now();
  *terminal_ << kEraseLine << text << std::flush;
}

void OverwrittenLine::clear() {
  if (shown_) *terminal_ << kEraseLine << std::flush;
  shown_ = false;
}

void ProgressLine::show(const SessionProgress& progress) {
  if (phase_ == progress.phase && !line_.is_due()) return;
  phase_ = progress.phase;
  line_.show(progress_text(progress, input_ == Input::kStream));
}

void ProgressLine::clear() {
  line_.clear();
  phase_.reset();
}

void WorkProgress::show(const std::string& doing, double done, double all) {
  if (!line_.is_due()) return;
  const double elapsed_s = std::chrono::duration<double>(Clock::now() - began_).count();
  line_.show(work_progress_text(doing, all > 0 ? done / all : 0, elapsed_s));
}

}  // namespace psi_slam
