// SPDX-License-Identifier: BSD-3-Clause
// Makes the runs of a sweep or of the Freiburg benchmark on the ranks of an MPI job. These commands start it:
//
//     mpirun -n 9 psi-slam sweep --mpi LOG... -o DIR [--set SECTION.KEY=V,V]...
//     mpirun -n 9 psi-slam bench freiburg --mpi --data DIR -o DIR [--seeds 10]...
//
// All ranks need the logs, the settings and the output folder under the same paths. Each run has a process of
// its own, so that a crash does not end a rank.
#include <algorithm>

#include "base/exit_code.h"
#include "command_line.h"
#include "common/bench_command.h"
#include "mpi_program.h"
#include "psi_slam/user_error.h"
#include "sweep_command.h"

namespace psi_slam {
namespace {

constexpr const char* kName = "psi-slam-mpi";
constexpr const char* kSweep = "sweep";

/// Lets `command` refuse an option that it has only without --mpi. `why` ends with what to do.
void refuse(CLI::App& command, const std::string& option, const std::string& why) {
  command
      .add_option_function<std::string>(
          option, [=](const std::string&) { throw UserError(option + " contradicts --mpi: " + why); })
      ->expected(0, 1)
      ->group("");
}

/// Lets `command` refuse --processes.
void refuse_processes(CLI::App& command) {
  refuse(command, "--processes",
         "each rank makes one run at a time. Choose the number of ranks with mpirun -n");
}

/// Adds the command `sweep` and returns its work.
std::function<int()> define_sweep(CLI::App& app, int ranks, const Streams& streams) {
  const auto arguments = std::make_shared<SweepArguments>();
  CLI::App& sweep = *app.add_subcommand(
      kSweep, "Map many logs with many settings and compare the results (exit code 1 if a run failed)");
  add_sweep_options(sweep, *arguments);
  refuse_processes(sweep);
  sweep.allow_extras();
  return [=, &sweep, &streams] {
    if (const std::vector<std::string> unknown = sweep.remaining(); !unknown.empty())
      throw UserError(unknown_argument_text(unknown.front(), sweep, "psi-slam sweep"));
    const SweepWorkers workers = ranks == 1 ? local_workers(1) : rank_workers<SweepOrder, SweepOutcome>();
    return run_sweep_command(*arguments, workers, program_beside("psi-slam", kName), streams);
  };
}

/// Adds the command `freiburg`. Parsing runs it, unless `ranks` is 0.
void define_freiburg(CLI::App& app, int ranks, const Streams& streams) {
  FreiburgOptions options;
  if (ranks > 0) options.program = program_beside("psi-slam-bench", kName);
  options.processes = std::max(1, ranks - 1);
  // Rank 0 does the work itself if it is alone.
  options.workers = ranks < 2 ? local_child_workers(1) : rank_workers<ChildWords, ChildEnd>();
  CLI::App& freiburg = add_freiburg_command(app, streams, options, ranks == 0);
  refuse_processes(freiburg);
  const std::string only_here = "baselines run on one machine. Measure them by the command without --mpi";
  refuse(freiburg, "--baselines", only_here);
  refuse(freiburg, "--baseline-limit-s", only_here);
}

/// Adds both commands. `sweeps` tells whether the command line begins with `sweep`.
std::function<int()> define(CLI::App& app, int ranks, const Streams& streams, bool sweeps) {
  const std::function<int()> sweep = define_sweep(app, ranks, streams);
  define_freiburg(app, sweeps ? 0 : ranks, streams);
  app.require_subcommand(1);
  return sweeps ? sweep : [] { return kExitDone; };
}

}  // namespace
}  // namespace psi_slam

int main(int argc, char** argv) {
  using namespace psi_slam;
  const bool sweeps = argc > 1 && std::string(argv[1]) == kSweep;
  return run_mpi_program(
      argc, argv,
      {kName, "Makes the runs of a sweep or of the Freiburg benchmark on the ranks of an MPI job.",
       "\nExamples:\n"
       "  mpirun -n 9 psi-slam sweep --mpi my.log -o sweep --seeds 10\n"
       "  mpirun -n 9 psi-slam sweep --mpi my.log -o sweep --set loop_closure.matcher=csm,ga\n"
       "  mpirun -n 9 psi-slam bench freiburg --mpi --data benchmark-logs --seeds 10 -o out/freiburg\n",
       [sweeps](CLI::App& app, int ranks, const Streams& streams) {
         return define(app, ranks, streams, sweeps);
       },
       sweeps ? text_maker(make_run) : text_maker(run_to_end), default_settings()});
}
