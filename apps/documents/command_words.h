// SPDX-License-Identifier: BSD-3-Clause
// Options, arguments and commands of a command line, as its documents show them.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace psi_slam {

/// Kind of an argument or of an option's value.
enum class WordKind { kNothing, kFile, kFolder, kSetting, kOther };

WordKind kind_of_value(const CLI::Option& option);

/// "FILE", "N"; empty for a flag. CLI11's notes on the accepted values are left out.
std::string value_name(const CLI::Option& option);

/// Those that are not hidden, in the order of their definition.
std::vector<const CLI::Option*> shown_options(const CLI::App& app);
std::vector<const CLI::Option*> shown_positionals(const CLI::App& app);
std::vector<const CLI::App*> shown_commands(const CLI::App& app);

/// Plain text of one or more lines for a manual page, with the characters that troff interprets escaped.
std::string roff_text(std::string_view text);

/// All names as a user types them: "-c", "--config".
std::vector<std::string> typed_names(const CLI::Option& option);

}  // namespace psi_slam
