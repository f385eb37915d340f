// SPDX-License-Identifier: BSD-3-Clause
// The format of --help, which shows options and values as the man pages do.
#pragma once

#include <CLI/CLI.hpp>

namespace psi_slam {

/// Lets --help of a program and of its commands show the name of each value and its default, without CLI11's
/// notes on types and accepted values. Call it after the commands are added.
void format_help(CLI::App& app);

}  // namespace psi_slam
