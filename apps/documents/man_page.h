// SPDX-License-Identifier: BSD-3-Clause
// Manual pages: psi-slam(1) and the like from the definition of a command line, psi-slam.ini(5) from the
// options.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "config/option_table.h"

namespace psi_slam {

/// The page of a program. Its description must begin with what follows "NAME is a program that", its name
/// first or left out; the first clause is the line of the section NAME.
std::string man_page(const CLI::App& app);

/// The page of the settings files; `version` is that of the programs.
std::string settings_man_page(const OptionTable& table, const std::string& version);

}  // namespace psi_slam
