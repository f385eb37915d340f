// SPDX-License-Identifier: BSD-3-Clause
// Options of the commands that read a driving robot instead of a log.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "live/live_source.h"
#include "pose_lines.h"

namespace psi_slam {

/// The options before their values are examined; empty texts were not given.
struct LiveArguments {
  bool standard_input = false;
  std::string tcp;          ///< number of the port
  std::string address;      ///< --bind
  std::string follow;       ///< log that grows
  std::string sensors;      ///< settings file of rawlog-grabber
  std::string idle_s;       ///< seconds
  std::string look_over_s;  ///< seconds
  std::string poses;        ///< "tum" or "json"
};

/// Adds the options of a source that fill `arguments`, except standard input.
void add_source_options(CLI::App& command, LiveArguments& arguments);

/// Adds all options that fill `arguments`.
void add_live_options(CLI::App& command, LiveArguments& arguments);

/// Returns the source that the options name; empty if they name none. Throws UserError if they name several
/// sources, if a value is invalid, or if an option has no effect.
std::optional<LiveInput> live_input(const LiveArguments& arguments);

/// Returns the form of the lines of poses; empty for none. Throws UserError for an unknown form.
std::optional<PoseFormat> pose_format(const LiveArguments& arguments);

}  // namespace psi_slam
