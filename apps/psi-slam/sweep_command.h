// SPDX-License-Identifier: BSD-3-Clause
// psi-slam sweep: maps many logs with many settings and seeds, and writes one report.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <string>

#include "batch/sweep.h"
#include "psi_slam_app.h"

namespace psi_slam {

struct SweepArguments {
  SweepRequest request;
  std::string output;
  SweepKeep keep = SweepKeep::kNone;
  int processes = 1;
  bool quiet = false;
};

/// Adds the options that fill `arguments`, which must outlive `command`. Parsing throws UserError for invalid
/// seeds and for an unknown word after --keep.
void add_sweep_options(CLI::App& command, SweepArguments& arguments);

/// Makes the sweep and its report; `program` is the path of psi-slam. Returns the exit code. After SIGINT or
/// SIGTERM the finished runs are kept and reported. Throws UserError for invalid input, and SystemFailure if
/// runs failed or were interrupted.
int run_sweep_command(const SweepArguments& arguments, const std::filesystem::path& program,
                      const Streams& streams);

}  // namespace psi_slam
