// SPDX-License-Identifier: BSD-3-Clause
// What the programs for clusters have in common: their main().
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
  /// Parses the command line and does nothing else; what it is asked to say of itself (--help, --version,
  /// documents) it throws as CLI::Success.
  std::function<void(CLI::App& app, const std::vector<std::string>& arguments)> parse;
  /// Of rank 0. Throws CLI::ParseError and UserError for mistakes of the user.
  std::function<int(const MpiWorld& world, const std::vector<std::string>& arguments, const Streams& streams)>
      run;
  /// Of the other ranks.
  MakeOrder make;
};

/// Runs the program as one rank of a job, or alone; returns its exit code. What it says of itself needs no
/// MPI, and one rank says it.
int run_mpi_program(int argc, char** argv, const MpiProgram& program);

/// Another program of ours: installed beside this one, or in the same build. Throws UserError where it is
/// not.
std::filesystem::path program_beside(const std::string& name, const std::string& own_name);

}  // namespace psi_slam
