// SPDX-License-Identifier: BSD-3-Clause
// The option --mpi: the commands that have it make their runs on the ranks of an MPI job. psi-slam-mpi does
// this work, so that the other programs do not depend on MPI.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

namespace psi_slam {

/// Adds --mpi to a command, for its help text and its completion. `words` are what starts the command, such
/// as "psi-slam sweep". Parsing the option throws UserError: call mpi_arguments() before parsing.
void add_mpi_option(CLI::App& command, const std::string& words);

/// Returns the arguments of psi-slam-mpi if `arguments` begin with `command` and contain --mpi, and nothing
/// otherwise. psi-slam-mpi reports mistakes in them, because it does so on one rank only.
std::optional<std::vector<std::string>> mpi_arguments(const std::vector<std::string>& arguments,
                                                      const std::string& command);

}  // namespace psi_slam
