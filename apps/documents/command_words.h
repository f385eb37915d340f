// SPDX-License-Identifier: BSD-3-Clause
// What a command line may hold, as CLI11 knows it: for those who write about it.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace psi_slam {

/// What stands behind an option, or in a place of its own.
enum class WordKind { kNothing, kFile, kFolder, kSetting, kOther };

WordKind kind_of_value(const CLI::Option& option);

/// "FILE", "N"; empty where the option is a flag. What CLI11 adds about the values taken is left out.
std::string value_name(const CLI::Option& option);

/// Those that people are told of, in the order of their definition.
std::vector<const CLI::Option*> shown_options(const CLI::App& app);
std::vector<const CLI::Option*> shown_positionals(const CLI::App& app);
std::vector<const CLI::App*> shown_commands(const CLI::App& app);

/// "-c", "--config": as they are typed.
std::vector<std::string> typed_names(const CLI::Option& option);

}  // namespace psi_slam
