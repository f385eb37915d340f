// SPDX-License-Identifier: BSD-3-Clause
// Lists all options: as a commented settings file, as help for a terminal, and as a page of the manual.
#pragma once

#include <string>

#include "config/option_table.h"

namespace psi_slam {

/// Returns a settings file with the help, range, default and current value of every option. Loading it
/// restores the current values bit for bit. Throws std::logic_error if a member has a value that its option
/// does not accept.
std::string dump(const OptionTable& table);

/// Returns the options with their help, for a terminal.
std::string help_text(const OptionTable& table);

/// Returns a Markdown page with a heading and a table for each section.
std::string markdown_reference(const OptionTable& table);

}  // namespace psi_slam
