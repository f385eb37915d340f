// SPDX-License-Identifier: BSD-3-Clause
// Exit codes and error messages of all programs.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <iosfwd>

namespace psi_slam {

/// Runs `work` and returns the exit code: that of `work`; kExitDone after --help and --version, which are
/// printed to `out`; kExitWrongUsageOrInput for CLI::ParseError and UserError; else kExitFailed, also if
/// `out` cannot be written. Prints one line to `err` for each error, beginning with the name of `app`.
int run_program(const CLI::App& app, std::ostream& out, std::ostream& err,
                const std::function<int()>& work) noexcept;

}  // namespace psi_slam
