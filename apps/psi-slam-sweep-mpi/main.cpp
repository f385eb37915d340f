// SPDX-License-Identifier: BSD-3-Clause
// psi-slam sweep on a cluster:
//
//     mpirun -n 5 psi-slam-sweep-mpi LOG... -o DIR [--set SECTION.KEY=V,V]...
//
// All ranks need the logs and the output folder under the same paths. Each run has a process of its own, so
// that a crash does not end a rank.
#include "command_line.h"
#include "document_options.h"
#include "mpi_program.h"
#include "psi_slam/user_error.h"
#include "psi_slam/version.h"
#include "sweep_command.h"

namespace psi_slam {
namespace {

constexpr const char* kName = "psi-slam-sweep-mpi";
constexpr const char* kExamples =
    "\nExamples:\n"
    "  mpirun -n 9 psi-slam-sweep-mpi my.log -o sweep --seeds 10\n"
    "  mpirun -n 9 psi-slam-sweep-mpi my.log -o sweep --set loop_closure.matcher=csm,ga\n";

SweepArguments parse(CLI::App& app, const std::vector<std::string>& arguments) {
  SweepArguments sweep;
  app.description("Maps many logs with many settings on the ranks of an MPI job and compares the results.");
  app.name(kName);
  add_sweep_options(app, sweep);
  app.set_version_flag("--version", std::string(kName) + " " PSI_SLAM_VERSION, "Print the version and exit");
  app.footer(kExamples);
  app.allow_extras();
  add_document_options(app, default_settings());
  app.parse(std::vector<std::string>(arguments.rbegin(),
                                     arguments.rend()));  // CLI11 expects the last argument first
  return sweep;
}

int run(const MpiWorld& world, const std::vector<std::string>& arguments, const Streams& streams) {
  CLI::App app;
  const SweepArguments sweep = parse(app, arguments);
  if (const std::vector<std::string> unknown = app.remaining(); !unknown.empty())
    throw UserError(unknown_argument_text(unknown.front(), app, kName));
  const SweepWorkers workers =
      world.ranks() == 1 ? local_workers(1) : rank_workers(world, order_text, read_outcome);
  return run_sweep_command(sweep, workers, program_beside("psi-slam", kName), streams);
}

}  // namespace
}  // namespace psi_slam

int main(int argc, char** argv) {
  using namespace psi_slam;
  return run_mpi_program(argc, argv,
                         {kName, [](CLI::App& app, const auto& words) { parse(app, words); }, run,
                          text_maker(read_order, make_run, outcome_text)});
}
