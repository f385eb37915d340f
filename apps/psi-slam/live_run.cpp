// SPDX-License-Identifier: BSD-3-Clause
#include "live_run.h"

#include <csignal>
#include <string>

namespace psi_slam {

LiveRun::LiveRun(const Streams& streams, bool shows_progress) : streams_(streams) {
  signals_.emplace();
  // A program that reads the poses must not end the mapping by its own end.
  std::signal(SIGPIPE, SIG_IGN);
  if (shows_progress) progress_line_.emplace(streams.err, ProgressLine::Input::kStream);
}

LiveControl LiveRun::control() {
  return {[this, &came = signals_->came()] { return came || left_; },
          [this](const std::string& sentence) {
            const std::lock_guard lock(printing_);
            if (left_) return;
            if (progress_line_) progress_line_->clear();
            streams_.err << "psi-slam: " << sentence << std::endl;
          }};
}

void LiveRun::show(const SessionProgress& progress) {
  const std::lock_guard lock(printing_);
  if (progress_line_) progress_line_->show(progress);
}

bool LiveRun::end() {
  leave();
  const bool interrupted = signals_->came();
  signals_.emplace();
  return interrupted;
}

void LiveRun::leave() {
  const std::lock_guard lock(printing_);
  left_ = true;
}

}  // namespace psi_slam
