// SPDX-License-Identifier: BSD-3-Clause
#include "interrupt_signals.h"

#include <array>

namespace psi_slam {
namespace {

std::array<std::atomic<bool>, InterruptSignals::kMostExpected> signal_came{};
std::atomic<std::size_t> received_signals{0};
std::atomic<std::size_t> expected_signals{1};
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<std::size_t>::is_always_lock_free,
              "a signal handler may only use lock-free objects");

extern "C" void on_signal(int) {
  const std::size_t before = received_signals.fetch_add(1);
  if (before < signal_came.size()) signal_came[before] = true;
  if (before + 1 < expected_signals) return;
  signal(SIGINT, SIG_DFL);
  signal(SIGTERM, SIG_DFL);
}

}  // namespace

InterruptSignals::InterruptSignals(std::size_t expected) {
  for (std::atomic<bool>& came : signal_came) came = false;
  received_signals = 0;
  expected_signals = expected;
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

const std::atomic<bool>& InterruptSignals::came(std::size_t number) const {
  return signal_came.at(number - 1);
}

}  // namespace psi_slam
