// SPDX-License-Identifier: BSD-3-Clause
// All options as texts for people: a commented settings file, the help of a command line, a page of a manual.
#pragma once

#include <string>

#include "config/option_table.h"

namespace psi_slam {

/// A settings file with every option, its help, unit, range and default above its present value. Loading it
/// restores the present values bit for bit. Throws std::logic_error if a member holds what its option would
/// not take.
std::string dump(const OptionTable& table);

/// The options with their help, for a terminal.
std::string help_text(const OptionTable& table);

/// A Markdown page: a heading and a table for each section.
std::string markdown_reference(const OptionTable& table);

}  // namespace psi_slam
