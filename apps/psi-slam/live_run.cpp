// SPDX-License-Identifier: BSD-3-Clause
#include "live_run.h"

#include <csignal>
#include <utility>

namespace psi_slam {

LiveRun::LiveRun(const Streams& streams) : streams_(streams) {
  signals_.emplace();
  // A program that reads the poses must not end the mapping by its own end.
  std::signal(SIGPIPE, SIG_IGN);
}

LiveControl LiveRun::control() {
  return {[this, &came = signals_->came()] { return came || left_; },
          [this](const std::string& sentence) {
            print([&] {
              before_message_();
              streams_.err << "psi-slam: " << sentence << std::endl;
            });
          }};
}

void LiveRun::print(const std::function<void()>& print) {
  const std::lock_guard lock(printing_);
  print();
}

bool LiveRun::end() {
  leave();
  const bool interrupted = signals_->came();
  signals_.emplace();
  return interrupted;
}

}  // namespace psi_slam
