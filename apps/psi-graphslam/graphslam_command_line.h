// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "mrpt/graphslam_run.h"

namespace psi_slam {

struct GraphSlamCommandLine {
  GraphSlamSetup setup;
  std::string output;  ///< empty: output_dir_fname of the settings file
  bool force = false;
  bool list_node_deciders = false;
  bool list_edge_deciders = false;
  bool list_optimizers = false;
  bool dump_options = false;

  bool lists() const { return list_node_deciders || list_edge_deciders || list_optimizers; }
};

/// Parses the arguments, without the program's name. Throws CLI::ParseError for wrong usage, --help and
/// --version, and UserError for missing arguments and for --3d.
GraphSlamCommandLine parse_graphslam_command_line(const std::vector<std::string>& arguments, CLI::App& app);

}  // namespace psi_slam
