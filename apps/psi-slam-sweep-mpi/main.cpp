// SPDX-License-Identifier: BSD-3-Clause
// psi-slam sweep on a cluster:
//
//     mpirun -n 5 psi-slam-sweep-mpi LOG... -o DIR [--set SECTION.KEY=V,V]...
//
// Ranks need a file system in common, with the logs and the folder under the same names.
#include <unistd.h>

#include <csignal>
#include <exception>
#include <iostream>

#include "command_line.h"
#include "mpi_workers.h"
#include "psi_slam/base/user_error.h"
#include "sweep_command.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kName = "psi-slam-sweep-mpi";

/// psi-slam, which does the runs: installed beside this program, or in the same build.
fs::path psi_slam_program() {
  const fs::path folder = fs::read_symlink("/proc/self/exe").parent_path();
  for (const fs::path& program : {folder / "psi-slam", folder.parent_path() / "psi-slam" / "psi-slam"})
    if (fs::is_regular_file(program)) return program;
  throw UserError("psi-slam, which does the runs, is not beside " + (folder / kName).string());
}

int run_sweep_of(const MpiWorld& world, const std::vector<std::string>& arguments, const Streams& streams) {
  CLI::App app("Maps many logs with many settings on the ranks of an MPI job, and compares.", kName);
  SweepArguments sweep;
  add_sweep_options(app, sweep);
  app.set_version_flag("--version", std::string(kName) + " " PSI_SLAM_VERSION, "Print the version, and exit");
  app.allow_extras();
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
    if (const std::vector<std::string> unknown = app.remaining(); !unknown.empty())
      throw UserError(unknown_argument_text(unknown.front(), app, kName));
    return run_sweep_command(sweep, mpi_workers(world), psi_slam_program(), streams);
  } catch (const CLI::ParseError& error) {
    return app.exit(error, streams.out, streams.err) == 0 ? 0 : 2;
  } catch (const UserError& error) {
    streams.err << kName << ": " << error.what() << '\n';
    return 2;
  } catch (const std::exception& error) {
    streams.err << kName << ": " << error.what() << '\n';
    return 1;
  }
}

}  // namespace
}  // namespace psi_slam

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // as in psi-slam
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
