// SPDX-License-Identifier: BSD-3-Clause
#include "interrupt_signals.h"

namespace psi_slam {
namespace {

std::atomic<bool> signal_came{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only use lock-free objects");

extern "C" void on_signal(int) {
  signal_came = true;
  signal(SIGINT, SIG_DFL);
  signal(SIGTERM, SIG_DFL);
}

}  // namespace

InterruptSignals::InterruptSignals() {
  signal_came = false;
  struct sigaction action = {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;  // a signal does not make reads and writes fail
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, &previous_interrupt_);
  sigaction(SIGTERM, &action, &previous_terminate_);
}

InterruptSignals::~InterruptSignals() {
  sigaction(SIGINT, &previous_interrupt_, nullptr);
  sigaction(SIGTERM, &previous_terminate_, nullptr);
}

const std::atomic<bool>& InterruptSignals::came() const {
  return signal_came;
}

}  // namespace psi_slam
