// SPDX-License-Identifier: BSD-3-Clause
// The main function of the programs for clusters.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "mpi_ranks.h"
#include "psi_slam_app.h"

namespace psi_slam {

struct MpiProgram {
  std::string name;
  /// Parses the command line without running a command. Throws CLI::Success for --help, --version and
  /// documents.
  std::function<void(CLI::App& app, const std::vector<std::string>& arguments)> parse;
  /// The work of rank 0. Throws CLI::ParseError and UserError for mistakes of the user.
  std::function<int(const MpiWorld& world, const std::vector<std::string>& arguments, const Streams& streams)>
      run;
  /// Carries out one work order on another rank.
  MakeOrder make;
};

/// Runs the program as one rank of a job, or alone, and returns its exit code. --help, --version and
/// documents work without MPI and are printed by one rank.
int run_mpi_program(int argc, char** argv, const MpiProgram& program);

/// Path of another program of psi-slam, installed beside this one or in the same build. Throws UserError if
/// it does not exist.
std::filesystem::path program_beside(const std::string& name, const std::string& own_name);

}  // namespace psi_slam
