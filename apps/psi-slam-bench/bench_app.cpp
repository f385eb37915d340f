// SPDX-License-Identifier: BSD-3-Clause
#include "bench_app.h"

#include <CLI/CLI.hpp>
#include <ostream>

#include "base/exit_code.h"
#include "base/text_parts.h"
#include "common/bench_command.h"
#include "document_options.h"
#include "psi_slam/version.h"
#include "run_program.h"

namespace psi_slam {
namespace {

/// The arguments in the order that CLI11 expects, last first. Old names of options are replaced.
std::vector<std::string> for_parser(const std::vector<std::string>& arguments) {
  constexpr std::string_view kOld = "--rival";
  std::vector<std::string> reversed(arguments.rbegin(), arguments.rend());
  for (std::string& argument : reversed)
    if (starts_with(argument, kOld)) argument.replace(0, kOld.size(), "--baseline");
  return reversed;
}

}  // namespace

int run_bench_app(const std::vector<std::string>& arguments, const Streams& streams) noexcept {
  CLI::App app("Measures accuracy and speed of psi-slam and of its parts.", "psi-slam-bench");
  return run_program(app, streams.out, streams.err, [&] {
    add_freiburg_command(app, streams);
    add_freiburg_run_command(app, streams);
    add_match_command(app, streams);
    add_simulate_command(app, streams);
    add_false_loops_command(app, streams);
    add_robustness_command(app, streams);
    app.require_subcommand(1);
    app.set_version_flag("--version", "psi-slam-bench " PSI_SLAM_VERSION, "Print the version and exit");
    add_document_options(app);
    app.parse(for_parser(arguments));
    return kExitDone;
  });
}

}  // namespace psi_slam
