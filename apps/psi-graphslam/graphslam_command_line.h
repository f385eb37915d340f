// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "mrpt/graphslam_run.h"

namespace psi_slam {

struct GraphSlamCommandLine {
  GraphSlamSetup setup;
  std::string output;  ///< empty: as the settings file says
  bool force = false;
  bool list_node_deciders = false;
  bool list_edge_deciders = false;
  bool list_optimizers = false;
  bool dump_options = false;

  bool lists() const { return list_node_deciders || list_edge_deciders || list_optimizers; }
};

/// The arguments behind the program's name. Exceptions of CLI11 tell of wrong usage, --help and --version;
/// throws UserError when something is missing, and for maps of space, which ours are not.
GraphSlamCommandLine parse_graphslam_command_line(const std::vector<std::string>& arguments, CLI::App& app);

}  // namespace psi_slam
