// SPDX-License-Identifier: BSD-3-Clause
// Exit codes and error messages of all programs.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <iosfwd>
#include <string>

#include "base/exit_code.h"

namespace psi_slam {

/// Name of the program and of the command that it has parsed: "psi-slam merge".
std::string parsed_words(const CLI::App& app);

/// Runs `work` and returns its exit code, or `failed` if `out` cannot be written. Prints the text of --help
/// and --version to `out` and returns kExitDone. Returns kExitWrongUsageOrInput after CLI::ParseError and
/// UserError, and `failed` after any other std::exception; `work` may change `failed` while it runs. Prints
/// one line to `err` for each error, beginning with the name of `app`. After CLI::ParseError, the line names
/// the help of the command.
int run_program(const CLI::App& app, std::ostream& out, std::ostream& err, const std::function<int()>& work,
                const int& failed = kExitFailed) noexcept;

}  // namespace psi_slam
