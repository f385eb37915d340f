// SPDX-License-Identifier: BSD-3-Clause
#include "bench_app.h"

#include <CLI/CLI.hpp>
#include <ostream>

#include "base/exit_code.h"
#include "common/bench_command.h"
#include "document_options.h"
#include "run_program.h"

namespace psi_slam {

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
    app.parse(std::vector<std::string>(arguments.rbegin(),
                                       arguments.rend()));  // CLI11 expects the last argument first
    return kExitDone;
  });
}

}  // namespace psi_slam
