// SPDX-License-Identifier: BSD-3-Clause
// psi-slam sweep on a cluster:
//
//     mpirun -n 5 psi-slam-sweep-mpi LOG... -o DIR [--set SECTION.KEY=V,V]...
//
// Ranks need a file system in common, with the logs and the folder under the same names.
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <optional>
#include <sstream>

#include "command_line.h"
#include "document_options.h"
#include "mpi_workers.h"
#include "psi_slam/base/exit_code.h"
#include "psi_slam/base/user_error.h"
#include "sweep_command.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kName = "psi-slam-sweep-mpi";
constexpr const char* kExamples =
    "\nExamples:\n"
    "  mpirun -n 9 psi-slam-sweep-mpi my.log -o sweep --seeds 10\n"
    "  mpirun -n 9 psi-slam-sweep-mpi my.log -o sweep --set loop_closure.matcher=csm,ga\n";

/// psi-slam, which does the runs: installed beside this program, or in the same build.
fs::path psi_slam_program() {
  const fs::path folder = fs::read_symlink("/proc/self/exe").parent_path();
  for (const fs::path& program : {folder / "psi-slam", folder.parent_path() / "psi-slam" / "psi-slam"})
    if (fs::is_regular_file(program)) return program;
  throw UserError("psi-slam, which does the runs, is not beside " + (folder / kName).string());
}

/// The command line; parsing fills `sweep`.
void define(CLI::App& app, SweepArguments& sweep) {
  app.description("Maps many logs with many settings on the ranks of an MPI job, and compares.");
  app.name(kName);
  add_sweep_options(app, sweep);
  app.set_version_flag("--version", std::string(kName) + " " PSI_SLAM_VERSION, "Print the version, and exit");
  app.footer(kExamples);
  app.allow_extras();
  add_document_options(app, default_settings());
}

void parse(CLI::App& app, const std::vector<std::string>& arguments) {
  app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));  // CLI11 takes them last first
}

/// Whether this process is another rank than the first of those that a starter of MPI jobs has started.
bool is_started_as_later_rank() {
  for (const char* variable : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"})
    if (const char* const rank = std::getenv(variable); rank != nullptr) return std::string(rank) != "0";
  return false;
}

/// What the program says of itself (--help, --version, its documents), for which MPI need not run; nothing
/// when it is asked for something else.
std::optional<std::string> words_of_itself(const std::vector<std::string>& arguments) {
  CLI::App app;
  SweepArguments sweep;
  define(app, sweep);
  try {
    parse(app, arguments);
  } catch (const CLI::Success& asked) {
    std::ostringstream words;
    app.exit(asked, words, words);
    return words.str();
  } catch (const std::exception&) {  // told when MPI runs, by one rank
  }
  return std::nullopt;
}

int run_sweep_of(const MpiWorld& world, const std::vector<std::string>& arguments, const Streams& streams) {
  CLI::App app;
  SweepArguments sweep;
  define(app, sweep);
  try {
    parse(app, arguments);
    if (const std::vector<std::string> unknown = app.remaining(); !unknown.empty())
      throw UserError(unknown_argument_text(unknown.front(), app, kName));
    return run_sweep_command(sweep, mpi_workers(world), psi_slam_program(), streams);
  } catch (const CLI::ParseError& error) {
    return app.exit(error, streams.out, streams.err) == 0 ? kExitDone : kExitWrongUsageOrInput;
  } catch (const UserError& error) {
    streams.err << kName << ": " << error.what() << '\n';
    return kExitWrongUsageOrInput;
  } catch (const std::exception& error) {
    streams.err << kName << ": " << error.what() << '\n';
    return kExitFailed;
  }
}

}  // namespace
}  // namespace psi_slam

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // as in psi-slam
  if (const auto words = psi_slam::words_of_itself({argv + 1, argv + argc})) {
    if (!psi_slam::is_started_as_later_rank()) std::cout << *words << std::flush;
    return std::cout ? 0 : 1;
  }
  const psi_slam::MpiWorld world(argc, argv);
  if (world.rank() > 0) {
    psi_slam::work_for_rank_0(world);
    return 0;
  }
  const int code = psi_slam::run_sweep_of(world, {argv + 1, argv + argc},
                                          {std::cout, std::cerr, ::isatty(STDERR_FILENO) == 1});
  psi_slam::dismiss_workers(world);
  return code;
}
