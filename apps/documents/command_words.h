// SPDX-License-Identifier: BSD-3-Clause
// Options, arguments and commands of a command line, as man pages and shell completion show them.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace psi_slam {

/// Kind of an argument or of an option's value.
enum class WordKind { kNothing, kFile, kFolder, kSetting, kCommand, kOther };

WordKind kind_of_value(const CLI::Option& option);

/// Name of the option's value, such as "FILE" or "N", without CLI11's notes on accepted values. Empty for a
/// flag.
std::string value_name(const CLI::Option& option);

/// Description of the option, with its default in parentheses, and with "(required)" after it if the option
/// must be given.
std::string option_text(const CLI::Option& option);

/// True for an argument that may be repeated.
bool takes_many(const CLI::Option& positional);

/// Options and commands that are not hidden, and all positional arguments, in the order of their definition.
std::vector<const CLI::Option*> shown_options(const CLI::App& app);
std::vector<const CLI::Option*> shown_positionals(const CLI::App& app);
std::vector<const CLI::App*> shown_commands(const CLI::App& app);

/// Escapes the characters that troff interprets in a plain text. The text may have several lines.
std::string roff_text(std::string_view text);

/// All names of an option as a user types them: "-c", "--config".
std::vector<std::string> typed_names(const CLI::Option& option);

}  // namespace psi_slam
