// SPDX-License-Identifier: BSD-3-Clause
// Settings as text: reads them from files and the command line into the structs that an OptionTable is bound
// to. Lists all options as a commented settings file, as help for a terminal, and as a page of the manual.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "base/config/ini_file.h"
#include "base/config/option_table.h"

namespace psi_slam {

/// Sets every value of the file. Throws UserError with file and line for an unknown section or key (with the
/// nearest name), and for a value that the option does not accept. Throws UserError also if one file sets an
/// option by both its old and its new name. After an error, no setting has changed. `table` collects a
/// warning for each old name.
void apply(const IniFile& file, OptionTable& table);

/// Sets one value as given on the command line: "section.key=value". `with_constants`: by set_any(). Throws
/// UserError that begins with "--set".
void apply_override(std::string_view assignment, OptionTable& table, bool with_constants = false);

/// Returns an option as lines of a settings file, under the key `name`: its help, range, default and current
/// value.
std::string commented(const Option& option, const std::string& name);

/// Returns the text of a settings file with the help, range, default and current value of every option, and
/// with the constants that were changed. Loading this file restores the values of options bit for bit. Throws
/// std::logic_error if a member has a value that its option does not accept.
std::string dump(const OptionTable& table);

/// Returns the options that `selects` accepts with their help, range and default, for a terminal. Empty if
/// there is none.
std::string help_text(
    const OptionTable& table,
    const std::function<bool(const Option&)>& selects = [](const Option&) { return true; });

/// Returns a Markdown page of all options, with a heading and a table for each section.
std::string markdown_reference(const OptionTable& table);

}  // namespace psi_slam
