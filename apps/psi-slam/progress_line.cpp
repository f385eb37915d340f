// SPDX-License-Identifier: BSD-3-Clause
#include "progress_line.h"

#include <cmath>
#include <cstdio>
#include <ostream>

namespace psi_slam {
namespace {

constexpr std::chrono::milliseconds kBetweenUpdates{200};
constexpr const char* kEraseLine = "\r\x1b[K";

}  // namespace

std::string minutes_text(double seconds) {
  const auto whole = static_cast<long long>(std::llround(seconds));
  char text[64];
  if (whole < 3600)
    std::snprintf(text, sizeof text, "%lld:%02lld", whole / 60, whole % 60);
  else
    std::snprintf(text, sizeof text, "%lld:%02lld:%02lld", whole / 3600, whole / 60 % 60, whole % 60);
  return text;
}

std::string progress_text(const SessionProgress& progress) {
  using Phase = SessionProgress::Phase;
  if (progress.phase == Phase::kWriting) return "drawing the map and writing the results";
  char text[128];
  if (progress.phase == Phase::kMapping)
    std::snprintf(text, sizeof text, "%3.0f %%   %zu scans   %.0f scans/s", 100 * progress.share,
                  progress.scans, progress.scans_per_s);
  else
    std::snprintf(text, sizeof text, "%3.0f %%   looking for loops once more", 100 * progress.share);
  std::string line = text;
  if (progress.remaining_s) line += "   " + minutes_text(*progress.remaining_s) + " left";
  return line;
}

void ProgressLine::show(const SessionProgress& progress) {
  const auto now = std::chrono::steady_clock::now();
  if (phase_ == progress.phase && now - shown_at_ < kBetweenUpdates) return;
  phase_ = progress.phase;
  shown_at_ = now;
  terminal_ << kEraseLine << progress_text(progress) << std::flush;
}

void ProgressLine::clear() {
  if (phase_) terminal_ << kEraseLine << std::flush;
  phase_.reset();
}

}  // namespace psi_slam
