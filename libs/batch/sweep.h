// SPDX-License-Identifier: BSD-3-Clause
// A sweep made: runs that are there are taken as they are, the others are handed to workers.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "batch/sweep_plan.h"
#include "batch/sweep_run.h"

namespace psi_slam {

struct SweepOptions {
  std::filesystem::path output;                      ///< the runs are output/runs/NAME/
  SweepKeep keep = SweepKeep::kNone;                 ///< of each
  std::filesystem::path program = "/proc/self/exe";  ///< psi-slam, which does the runs
};

/// What workers tell and ask; by several threads where they are threads, each about orders of its own.
struct SweepWatch {
  std::function<bool()> stop;                                     ///< once true, no more runs
  std::function<void(std::size_t order)> working;                 ///< a few times a second
  std::function<void(std::size_t order, SweepOutcome)> finished;  ///< once for each that was not stopped
};

/// Makes all the orders, each by make_run().
using SweepWorkers = std::function<void(const std::vector<SweepOrder>&, const SweepWatch&)>;

/// So many processes at a time on this machine.
SweepWorkers local_workers(int processes);

struct SweepResult {
  std::vector<std::optional<SweepOutcome>> outcomes;  ///< of the plan's runs; none: not made yet

  std::size_t to_go() const;
  std::size_t failed() const;
  std::size_t made_now() const;
};

/// While it lives, no other sweep works in the folder. Throws UserError when another one does, on this
/// machine or on one that shares its locks.
class SweepLock {
 public:
  explicit SweepLock(const std::filesystem::path& folder);
  ~SweepLock();
  SweepLock(const SweepLock&) = delete;
  SweepLock& operator=(const SweepLock&) = delete;

 private:
  int file_ = -1;
};

/// `progress` takes what is being done and how much of all is done, one call at a time.
SweepResult run_sweep(const SweepPlan& plan, const SweepOptions& options, const SweepWorkers& workers,
                      const std::function<bool()>& stop,
                      const std::function<void(const std::string&, double, double)>& progress);

}  // namespace psi_slam
