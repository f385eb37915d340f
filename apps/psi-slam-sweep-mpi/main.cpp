// SPDX-License-Identifier: BSD-3-Clause
// Runs the command `psi-slam sweep` on a cluster:
//
//     mpirun -n 5 psi-slam-sweep-mpi LOG... -o DIR [--set SECTION.KEY=V,V]...
//
// All ranks need the logs and the output folder under the same paths. Each run has a process of its own, so
// that a crash does not end a rank.
#include "command_line.h"
#include "mpi_program.h"
#include "psi_slam/user_error.h"
#include "sweep_command.h"

namespace psi_slam {
namespace {

constexpr const char* kName = "psi-slam-sweep-mpi";

std::function<int()> define(CLI::App& app, int ranks, const Streams& streams) {
  const auto sweep = std::make_shared<SweepArguments>();
  add_sweep_options(app, *sweep);
  app.allow_extras();
  return [=, &app, &streams] {
    if (const std::vector<std::string> unknown = app.remaining(); !unknown.empty())
      throw UserError(unknown_argument_text(unknown.front(), app, kName));
    const SweepWorkers workers = ranks == 1 ? local_workers(1) : rank_workers<SweepOrder, SweepOutcome>();
    return run_sweep_command(*sweep, workers, program_beside("psi-slam", kName), streams);
  };
}

}  // namespace
}  // namespace psi_slam

int main(int argc, char** argv) {
  using namespace psi_slam;
  return run_mpi_program(
      argc, argv,
      {kName, "Maps many logs with many settings on the ranks of an MPI job and compares the results.",
       "\nExamples:\n"
       "  mpirun -n 9 psi-slam-sweep-mpi my.log -o sweep --seeds 10\n"
       "  mpirun -n 9 psi-slam-sweep-mpi my.log -o sweep --set loop_closure.matcher=csm,ga\n",
       define, text_maker(make_run), default_settings()});
}
