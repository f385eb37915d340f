// SPDX-License-Identifier: BSD-3-Clause
// psi-slam-bench freiburg on a cluster:
//
//     mpirun -n 9 psi-slam-bench-mpi freiburg --data DIR -o DIR [--seeds 10]...
//
// All ranks need the logs, the settings and the output folder under the same paths.
#include <algorithm>
#include <iostream>

#include "base/exit_code.h"
#include "batch/child_process.h"
#include "common/bench_command.h"
#include "document_options.h"
#include "mpi_program.h"
#include "psi_slam/version.h"

namespace psi_slam {
namespace {

constexpr const char* kName = "psi-slam-bench-mpi";
constexpr const char* kExamples =
    "\nExamples:\n"
    "  mpirun -n 9 psi-slam-bench-mpi freiburg --data benchmark-logs --seeds 10 -o out/freiburg\n";

void define(CLI::App& app, const Streams& streams, const FreiburgWork& work) {
  app.description(
      "Maps the logs of the Freiburg benchmark on the ranks of an MPI job and compares with other systems.");
  app.name(kName);
  add_freiburg_command(app, streams, work);
  app.require_subcommand(1);
  app.set_version_flag("--version", std::string(kName) + " " PSI_SLAM_VERSION, "Print the version and exit");
  app.footer(kExamples);
  add_document_options(app);
}

/// Rank 0 does the work itself if it is alone.
ChildWorkers workers_of(const MpiWorld& world) {
  return world.ranks() == 1 ? local_child_workers(1) : rank_workers(world, child_words_text, read_child_end);
}

void take_words(CLI::App& app, const std::vector<std::string>& arguments) {
  app.parse(std::vector<std::string>(arguments.rbegin(),
                                     arguments.rend()));  // CLI11 expects the last argument first
}

void parse(CLI::App& app, const std::vector<std::string>& arguments) {
  const Streams nowhere{std::cout, std::cerr, false};
  define(app, nowhere, {kName, local_child_workers(1), 1, true});
  take_words(app, arguments);
}

int run(const MpiWorld& world, const std::vector<std::string>& arguments, const Streams& streams) {
  CLI::App app;
  define(app, streams,
         {program_beside("psi-slam-bench", kName), workers_of(world), std::max(1, world.ranks() - 1), false});
  take_words(app, arguments);
  return kExitDone;
}

}  // namespace
}  // namespace psi_slam

int main(int argc, char** argv) {
  using namespace psi_slam;
  return run_mpi_program(argc, argv,
                         {kName, parse, run, text_maker(read_child_words, run_to_end, child_end_text)});
}
