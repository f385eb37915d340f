// SPDX-License-Identifier: BSD-3-Clause
// Runs a sweep: reuses the results of finished runs and makes the remaining runs.
#pragma once

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

#include "base/descriptor.h"
#include "batch/sweep_plan.h"
#include "batch/sweep_run.h"
#include "batch/workers.h"

namespace psi_slam {

struct SweepOptions {
  std::filesystem::path output;       ///< folder of the sweep; each run has a folder output/runs/NAME/
  SweepKeep keep = SweepKeep::kNone;  ///< files to keep of each run
  std::filesystem::path program = "/proc/self/exe";  ///< the psi-slam program that makes the runs
};

struct SweepResult {
  std::vector<std::optional<SweepOutcome>> outcomes;  ///< one for each run of the plan; empty: not made yet

  std::size_t to_go() const {
    return count([](const auto& outcome) { return !outcome; });
  }
  std::size_t failed() const {
    return count([](const auto& outcome) { return outcome && !outcome->figures; });
  }
  std::size_t made_now() const {
    return count([](const auto& outcome) { return outcome && outcome->attempts > 0; });
  }

 private:
  template <class IsOne>
  std::size_t count(const IsOne& is_one) const {
    return static_cast<std::size_t>(std::count_if(outcomes.begin(), outcomes.end(), is_one));
  }
};

/// Locks an output folder: no other sweep can write to it during the lifetime of this object. Throws
/// UserError if the lock file cannot be written. Throws UserError also if another sweep holds the lock, on
/// this machine or on another machine that shares its file locks.
class SweepLock {
 public:
  explicit SweepLock(const std::filesystem::path& folder);

 private:
  Descriptor file_;
};

/// Makes the runs of the plan that have no result from an earlier sweep, at most `processes` at a time. Runs
/// that have not ended when `stop` returns true get no outcome. Calls `progress` from one thread at a time.
SweepResult run_sweep(const SweepPlan& plan, const SweepOptions& options, int processes,
                      const std::function<bool()>& stop, const ProgressObserver& progress);

}  // namespace psi_slam
