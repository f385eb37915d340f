// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "config/option_table.h"
#include "session/settings.h"
#include "sweep_command.h"

namespace psi_slam {

/// What the user asked for, not yet looked at closer.
struct CommandLine {
  enum class Command { kMap, kCheck, kLocalize, kMerge, kOptions, kDumpConfig, kSweep };

  Command command = Command::kMap;
  std::string log;
  std::string map;    ///< to localize in
  std::string start;  ///< "X,Y,YAW_DEG" in the map; empty: unknown
  std::vector<std::string> inputs;  ///< to merge
  std::string output;
  std::string edits;                  ///< empty: none
  std::string resume;                 ///< a session file; empty: none
  std::string save_session;           ///< the same
  std::string config;                 ///< empty: the built-in defaults
  std::vector<std::string> settings;  ///< "section.key=value", in the order given
  std::optional<std::string> seed;
  std::optional<std::string> threads;
  bool force = false;
  bool json = false;
  bool quiet = false;
  bool verbose = false;
  bool markdown = false;
  SweepArguments sweep;
};

/// Reads the arguments with `app`, which was made for this. Throws CLI::ParseError for --help, --version and
/// unknown options, and UserError for arguments that do not go together.
CommandLine parse_command_line(const std::vector<std::string>& arguments, CLI::App& app);

/// The settings file's values over those that `bound` has, then --set, --seed and --threads. Throws UserError
/// for what is not accepted or does not go together.
void load_settings(const CommandLine& line, BoundSettings& bound);

/// The table of all settings, for those who write about them.
std::shared_ptr<const OptionTable> default_settings();

/// Adds -c and --set, which fill `config` and `settings`.
void add_settings_options(CLI::App& app, std::string& config, std::vector<std::string>& settings);

/// What the program says of the first of several arguments that `app` does not know; `program` is its name.
std::string unknown_argument_text(const std::string& argument, const CLI::App& app,
                                  const std::string& program);

}  // namespace psi_slam
