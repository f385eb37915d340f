// SPDX-License-Identifier: BSD-3-Clause
#include "live_run.h"

#include <csignal>
#include <string>
#include <utility>

namespace psi_slam {

// A program that reads the poses must not end the mapping by its own end.
LiveRun::LiveRun(const Streams& streams, bool shows_progress, std::string at_interrupt)
    : streams_(streams),
      at_interrupt_(std::move(at_interrupt)),
      previous_pipe_(std::signal(SIGPIPE, SIG_IGN)) {
  if (shows_progress) progress_line_.emplace(streams.err, ProgressLine::Input::kStream);
}

LiveRun::~LiveRun() {
  std::signal(SIGPIPE, previous_pipe_);
}

LiveControl LiveRun::control() {
  return {[this] {
            print_interrupt();
            return signals_.came() || left_;
          },
          [this](const std::string& sentence) { print(sentence); }};
}

void LiveRun::print(const std::string& sentence) {
  const std::lock_guard lock(printing_);
  if (left_) return;
  if (progress_line_) progress_line_->clear();
  streams_.err << "psi-slam: " << sentence << std::endl;
}

/// Tells that Ctrl-C came. A signal handler may not print.
void LiveRun::print_interrupt() {
  if (signals_.came() && !printed_interrupt_.exchange(true)) print(at_interrupt_);
}

void LiveRun::show(const SessionProgress& progress) {
  print_interrupt();
  const std::lock_guard lock(printing_);
  if (progress_line_) progress_line_->show(progress);
}

void LiveRun::end() {
  print_interrupt();
  leave();
  ended_by_signal_ = signals_.came();
}

void LiveRun::leave() {
  const std::lock_guard lock(printing_);
  left_ = true;
}

}  // namespace psi_slam
