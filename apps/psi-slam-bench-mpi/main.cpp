// SPDX-License-Identifier: BSD-3-Clause
// Runs the command `psi-slam-bench freiburg` on a cluster:
//
//     mpirun -n 9 psi-slam-bench-mpi freiburg --data DIR -o DIR [--seeds 10]...
//
// All ranks need the logs, the settings and the output folder under the same paths.
#include <algorithm>

#include "base/exit_code.h"
#include "common/bench_command.h"
#include "mpi_program.h"

namespace psi_slam {
namespace {

constexpr const char* kName = "psi-slam-bench-mpi";

std::function<int()> define(CLI::App& app, int ranks, const Streams& streams) {
  FreiburgOptions options;
  if (ranks > 0) options.program = program_beside("psi-slam-bench", kName);
  options.processes = std::max(1, ranks - 1);
  // Rank 0 does the work itself if it is alone.
  options.workers = ranks < 2 ? local_child_workers(1) : rank_workers<ChildWords, ChildEnd>();
  add_freiburg_command(app, streams, options, ranks == 0);
  app.require_subcommand(1);
  return [] { return kExitDone; };
}

}  // namespace
}  // namespace psi_slam

int main(int argc, char** argv) {
  using namespace psi_slam;
  return run_mpi_program(
      argc, argv,
      {kName,
       "Maps the logs of the Freiburg benchmark on the ranks of an MPI job and compares with other systems.",
       "\nExamples:\n"
       "  mpirun -n 9 psi-slam-bench-mpi freiburg --data benchmark-logs --seeds 10 -o out/freiburg\n",
       define, text_maker(run_to_end)});
}
