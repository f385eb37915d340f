// SPDX-License-Identifier: BSD-3-Clause
// Completion of command lines in bash, and in zsh through its bashcompinit.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "config/option_table.h"

namespace psi_slam {

/// A script for bash that completes the program's commands and options, the files and folders behind them,
/// and keys and values of `settings` behind --set. It needs nothing but bash 4.
std::string bash_completion(const CLI::App& app, const OptionTable* settings);

}  // namespace psi_slam
