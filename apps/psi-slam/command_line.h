// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPose2D.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/config/option_table.h"
#include "live_arguments.h"
#include "map/trajectory/relations_metric.h"
#include "other_programs.h"
#include "psi_slam_app.h"
#include "session/settings.h"
#include "sweep_command.h"

namespace psi_slam {

/// The arguments of psi-slam diff alone.
struct DiffArguments {
  bool aligned = false;      ///< whether both maps have one frame
  std::string tolerance_m;   ///< empty: three cells
  std::string min_length_m;  ///< empty: the default of WallChangeOptions
};

/// The arguments of psi-slam eval alone.
struct EvalArguments {
  std::string trajectory;
  std::string relations;
  double max_gap_s = kMaxGap_s;
  std::string per_relation;  ///< file for the error of each relation; empty: not written
};

/// The arguments of psi-slam play alone.
struct PlayArguments {
  Ros2Arguments ros2;
  double speed = 1;  ///< times the speed of the robot
};

/// The arguments of psi-slam options alone.
struct OptionsArguments {
  std::string word;       ///< shows only options with this word in their name or description
  bool common = false;    ///< shows only the options that most users need
  bool markdown = false;  ///< prints a Markdown page of all options
};

/// The arguments of psi-slam, before their values are examined.
struct CommandLine {
  enum class Command {
    kMap,
    kCheck,
    kDiff,
    kEval,
    kLive,
    kLocalize,
    kMerge,
    kOptions,
    kPlay,
    kDumpConfig,
    kSweep,
    kOtherProgram
  };

  Command command = Command::kMap;
  std::string log;
  std::string map;                    ///< map file for localize
  std::string start;                  ///< "X,Y,YAW_DEG" in the map, of diff in the first map; empty: unknown
  std::vector<std::string> inputs;    ///< logs and sessions for merge; both maps for diff
  std::string output;                 ///< folder for the results
  std::string site;                   ///< folder of the site that the run continues; empty: none
  std::string edits;                  ///< file of edits of loops and of the drawn map; empty: no edits
  std::string resume;                 ///< session file to resume; empty: maps from the first scan
  std::string save_session;           ///< session file to write; empty: not written
  std::string journal;                ///< journal to write while mapping; empty: not written
  std::string config;                 ///< settings file; empty: the defaults
  std::vector<std::string> settings;  ///< "section.key=value", in the order given
  std::optional<std::string> seed;
  std::optional<std::string> threads;
  bool force = false;
  bool json = false;
  bool quiet = false;
  bool verbose = false;
  OptionsArguments options;
  DiffArguments diff;
  EvalArguments eval;
  LiveArguments live;
  PlayArguments play;
  SweepArguments sweep;
  std::optional<OtherProgram> other_program;  ///< program to start instead
  std::vector<std::string> other_arguments;   ///< its arguments
};

/// Parses the arguments with `app`, which must be new. Throws CLI::ParseError for --help, --version and
/// invalid options, and UserError for arguments that contradict each other.
CommandLine parse_command_line(const std::vector<std::string>& arguments, CLI::App& app);

/// Loads the settings file into `bound`, then applies --set, --seed and --threads. Prints a warning for each
/// old option name. Throws UserError for invalid values and for settings that contradict each other.
void load_settings(const CommandLine& line, BoundSettings& bound, const Streams& streams);

/// Parses --start, "X,Y,YAW_DEG" in metres and degrees, to a pose in radians. Throws UserError for any other
/// text.
mrpt::math::TPose2D parse_start(const std::string& text);

/// The table of all options with their defaults, for the documentation.
std::shared_ptr<const OptionTable> default_settings();

/// Adds -c and --set, which fill `config` and `settings`.
void add_settings_options(CLI::App& app, std::string& config, std::vector<std::string>& settings);

/// Error message for an argument that `app` does not know; `program` is the program's name.
std::string unknown_argument_text(const std::string& argument, const CLI::App& app,
                                  const std::string& program);

}  // namespace psi_slam
