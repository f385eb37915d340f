// SPDX-License-Identifier: BSD-3-Clause
// Exit codes and error messages of all programs.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <iosfwd>

namespace psi_slam {

/// Runs `work` and returns its exit code, or kExitFailed if `out` cannot be written. Prints the text of
/// --help and --version to `out` and returns kExitDone. Returns kExitWrongUsageOrInput after CLI::ParseError
/// and UserError, and kExitFailed after any other std::exception. Prints one line to `err` for each error,
/// beginning with the name of `app`.
int run_program(const CLI::App& app, std::ostream& out, std::ostream& err,
                const std::function<int()>& work) noexcept;

}  // namespace psi_slam
