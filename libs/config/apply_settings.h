// SPDX-License-Identifier: BSD-3-Clause
// Settings from files and the command line into the structs that an OptionTable is bound to.
#pragma once

#include <string>
#include <string_view>

#include "config/ini_file.h"
#include "config/option_table.h"

namespace psi_slam {

/// Sets every value of the file. Throws UserError with file and line for an unknown section or key (with the
/// nearest name), for a value that the option does not accept, and for an option that one file gives by its
/// old and its new name. Then no setting has changed. `table` collects a warning for each old name.
void apply(const IniFile& file, OptionTable& table);

/// Sets one value as given on the command line: "section.key=value". Throws UserError that begins with
/// "--set".
void apply_override(std::string_view assignment, OptionTable& table);

}  // namespace psi_slam
