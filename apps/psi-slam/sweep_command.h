// SPDX-License-Identifier: BSD-3-Clause
// psi-slam sweep: many logs with many settings and seeds, and one report of all.
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

/// Fills `arguments`, which outlives `command`, but for --processes: see add_processes_option(). Parsing
/// throws UserError for seeds that are none.
void add_sweep_options(CLI::App& command, SweepArguments& arguments);
void add_processes_option(CLI::App& command, SweepArguments& arguments);

/// Makes the sweep and its report; `program` is psi-slam, and `speaker` whoever complains. Returns the exit
/// code. SIGINT and SIGTERM end it in good order: what is finished is kept and reported. Throws UserError
/// when the user must mend something, and SystemFailure when runs failed.
int run_sweep_command(const SweepArguments& arguments, const SweepWorkers& workers,
                      const std::filesystem::path& program, const Streams& streams);

}  // namespace psi_slam
