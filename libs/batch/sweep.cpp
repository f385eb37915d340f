// SPDX-License-Identifier: BSD-3-Clause
#include "batch/sweep.h"

#include <fcntl.h>

#include "base/file_lock.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

SweepOrder order_of(const SweepPlan& plan, const SweepRun& run, const SweepOptions& options) {
  const SweepLog& log = plan.logs[run.log];
  return {options.program, log.log, log.relations.value_or(fs::path()),
          run.settings,    run.key, options.output / "runs" / run.folder,
          options.keep};
}

}  // namespace

SweepLock::SweepLock(const fs::path& folder) {
  const fs::path path = folder / ".lock";
  constexpr int kMode = 0644;
  file_ = Descriptor(::open(path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, kMode));
  if (!file_.is_open()) throw UserError(path.string() + " cannot be written: choose another folder with -o");
  if (!try_lock_file(file_))
    throw UserError("another sweep is running in " + folder.string() +
                    ": wait until it ends, or choose another folder with -o");
}

SweepResult run_sweep(const SweepPlan& plan, const SweepOptions& options, int processes,
                      const std::function<bool()>& stop, const ProgressObserver& progress) {
  SweepResult result;
  std::vector<SweepOrder> orders;
  std::vector<std::size_t> runs;  // for each order: index of its run
  std::vector<double> work;       // for each order: bytes of its log
  double all_work = 0;
  for (const SweepRun& run : plan.runs) {
    SweepOrder order = order_of(plan, run, options);
    result.outcomes.push_back(kept_outcome(order));
    if (result.outcomes.back()) continue;
    runs.push_back(result.outcomes.size() - 1);
    work.push_back(static_cast<double>(plan.logs[run.log].bytes));
    all_work += work.back();
    orders.push_back(std::move(order));
  }
  TaskProgress running(orders.size(), all_work, progress);
  WorkWatch<SweepOutcome> watch;
  watch.stop = stop;
  watch.working = [&](std::size_t order) { running.show(plan.runs[runs[order]].folder); };
  watch.finished = [&](std::size_t order, SweepOutcome outcome) {
    result.outcomes[runs[order]] = std::move(outcome);
    running.end(work[order]);
  };
  fs::create_directories(options.output / "runs");
  carry_out(orders, processes, make_run, watch);
  return result;
}

}  // namespace psi_slam
