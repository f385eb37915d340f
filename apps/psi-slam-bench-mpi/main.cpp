// SPDX-License-Identifier: BSD-3-Clause
// psi-slam-bench freiburg on a cluster:
//
//     mpirun -n 9 psi-slam-bench-mpi freiburg --data DIR -o DIR [--seeds 10]...
//
// Ranks need a file system in common, with the logs, the settings and the folder under the same names.
#include <algorithm>
#include <iostream>

#include "common/bench_command.h"
#include "document_options.h"
#include "mpi_program.h"
#include "base/exit_code.h"
#include "batch/child_workers.h"

namespace psi_slam {
namespace {

constexpr const char* kName = "psi-slam-bench-mpi";
constexpr const char* kExamples =
    "\nExamples:\n"
    "  mpirun -n 9 psi-slam-bench-mpi freiburg --data benchmark-logs --seeds 10 -o out/freiburg\n";

void define(CLI::App& app, const Streams& streams, const FreiburgWork& work) {
  app.description("Maps the logs of the Freiburg benchmark on the ranks of an MPI job, and compares.");
  app.name(kName);
  add_freiburg_command(app, streams, work);
  app.require_subcommand(1);
  app.set_version_flag("--version", std::string(kName) + " " PSI_SLAM_VERSION, "Print the version, and exit");
  app.footer(kExamples);
  add_document_options(app);
}

/// Where there is no other rank, rank 0 does the work itself.
ChildWorkers workers_of(const MpiWorld& world) {
  if (world.ranks() == 1) return local_child_workers(1);
  return [&world](const std::vector<ChildWords>& children, const ChildWatch& watch) {
    std::vector<std::string> orders;
    for (const ChildWords& words : children) orders.push_back(child_words_text(words));
    hand_out(world, orders, {watch.stop, watch.working, [&](std::size_t child, const std::string& end) {
                               watch.finished(child, read_child_end(end));
                             }});
  };
}

void take_words(CLI::App& app, const std::vector<std::string>& arguments) {
  app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));  // CLI11 takes them last first
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

std::optional<std::string> make(const std::string& order, const std::function<bool()>& stop) {
  const std::optional<ChildEnd> end = run_to_end(read_child_words(order), stop);
  if (!end) return std::nullopt;
  return child_end_text(*end);
}

}  // namespace
}  // namespace psi_slam

int main(int argc, char** argv) {
  using namespace psi_slam;
  return run_mpi_program(argc, argv, {kName, parse, run, make});
}
