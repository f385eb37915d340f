// SPDX-License-Identifier: BSD-3-Clause
#include "mpi_program.h"

#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <sstream>

#include "base/exit_code.h"
#include "psi_slam/user_error.h"
#include "run_program.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

/// True if a launcher of MPI jobs started this process as a rank other than 0.
bool is_started_as_later_rank() {
  for (const char* variable : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK", "PMI_RANK"})
    if (const char* const rank = std::getenv(variable); rank != nullptr) return std::string(rank) != "0";
  return false;
}

/// The text of --help, --version or a document; empty for other arguments.
std::optional<std::string> words_of_itself(const MpiProgram& program,
                                           const std::vector<std::string>& arguments) {
  CLI::App app;
  try {
    program.parse(app, arguments);
  } catch (const CLI::Success& asked) {
    std::ostringstream words;
    app.exit(asked, words, words);
    return words.str();
  } catch (const std::exception&) {  // reported by rank 0 when MPI runs
  }
  return std::nullopt;
}

int run_rank_0(const MpiWorld& world, const MpiProgram& program, const std::vector<std::string>& arguments) {
  const Streams streams{std::cout, std::cerr, ::isatty(STDERR_FILENO) == 1};
  CLI::App app;
  app.name(program.name);
  return run_program(app, streams.out, streams.err, [&] { return program.run(world, arguments, streams); });
}

}  // namespace

int run_mpi_program(int argc, char** argv, const MpiProgram& program) {
  std::signal(SIGXFSZ, SIG_IGN);  // as in psi-slam
  if (const auto words = words_of_itself(program, {argv + 1, argv + argc})) {
    if (!is_started_as_later_rank()) std::cout << *words << std::flush;
    return std::cout ? kExitDone : kExitFailed;
  }
  const MpiWorld world(argc, argv);
  if (world.rank() > 0) {
    work_for_rank_0(world, program.make);
    return kExitDone;
  }
  const int code = run_rank_0(world, program, {argv + 1, argv + argc});
  dismiss_workers(world);
  return code;
}

fs::path program_beside(const std::string& name, const std::string& own_name) {
  const fs::path folder = fs::read_symlink("/proc/self/exe").parent_path();
  for (const fs::path& program : {folder / name, folder.parent_path() / name / name})
    if (fs::is_regular_file(program)) return program;
  throw UserError(name + ", which makes the runs, was not found: expected it beside " +
                  (folder / own_name).string());
}

}  // namespace psi_slam
