// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>

#include "base/worker_pool.h"

namespace psi_slam {

/// Makes `count` things, so many at a time, under a SweepWatch or ChildWatch: `make` is given a number and
/// what it is to ask a few times a second, and returns what came of it, or none where that stopped it.
template <class Watch, class Make>
void make_at_a_time(int processes, std::size_t count, const Watch& watch, const Make& make) {
  WorkerPool pool(std::clamp(static_cast<int>(count), 1, processes));
  pool.run(count, [&](std::size_t index) {
    if (watch.stop()) return;
    auto outcome = make(index, [&] {
      watch.working(index);
      return watch.stop();
    });
    if (outcome) watch.finished(index, *std::move(outcome));
  });
}

}  // namespace psi_slam
