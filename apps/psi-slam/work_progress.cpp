// SPDX-License-Identifier: BSD-3-Clause
#include "work_progress.h"

#include <cstdio>
#include <ostream>

#include "progress_line.h"

namespace psi_slam {
namespace {

constexpr std::chrono::milliseconds kBetweenUpdates{200};
constexpr const char* kEraseLine = "\r\x1b[K";
constexpr double kEarlyShare = 0.01;  // before it the time left is guesswork

}  // namespace

std::string work_progress_text(const std::string& doing, double share, double elapsed_s) {
  char percent[32];
  std::snprintf(percent, sizeof percent, "   %3.0f %%", 100 * share);
  std::string line = doing + percent;
  if (share >= kEarlyShare) line += "   " + minutes_text(elapsed_s * (1 - share) / share) + " left";
  return line;
}

void WorkProgress::show(const std::string& doing, double done, double all) {
  if (terminal_ == nullptr) return;
  const auto now = std::chrono::steady_clock::now();
  if (shown_ && now - shown_at_ < kBetweenUpdates) return;
  shown_ = true;
  shown_at_ = now;
  const double share = all > 0 ? done / all : 0;
  const double elapsed_s = std::chrono::duration<double>(now - began_).count();
  *terminal_ << kEraseLine << work_progress_text(doing, share, elapsed_s) << std::flush;
}

void WorkProgress::clear() {
  if (shown_) *terminal_ << kEraseLine << std::flush;
  shown_ = false;
}

}  // namespace psi_slam
