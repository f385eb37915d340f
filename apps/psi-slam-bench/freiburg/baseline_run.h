// SPDX-License-Identifier: BSD-3-Clause
// Somebody else's mapper run on one of our logs, and its path held against the true relations as ours is. It
// is given every scan, as our reader has it, with the odometry between and the laser's mount.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/benchmark_logs.h"
#include "batch/run_figures.h"
#include "freiburg/baseline_program.h"

namespace psi_slam {

struct BaselineRun {
  BaselineProgram baseline;
  BenchmarkLog log;              ///< with its relations
  std::filesystem::path folder;  ///< for what it is given and what it writes
  double time_limit_s = 0;
};

struct BaselineResult {
  std::string log;
  std::string baseline;  ///< the name of its kind
  std::optional<RunFigures> figures;
  std::optional<double> not_finished_in_s;  ///< it was ended at this time limit
  std::string failure;                      ///< why there are no figures, if it was not the time limit
  bool made = false;                        ///< now; else it was there
};

/// Runs it to its end, or until `stop` is true: then its failure is "interrupted". Whatever goes wrong with
/// it is its failure. The folder keeps its settings and what it wrote. Throws SystemFailure when the folder
/// cannot be written.
BaselineResult run_baseline(const BaselineRun& run, const std::function<bool()>& stop);

/// The path in a file of lines "step x y ... yaw ...", a step for each of the times. Throws UserError where
/// it is not so.
Trajectory read_baseline_path(const std::filesystem::path& file, std::size_t yaw_column,
                           const std::vector<TimeUs>& times);

}  // namespace psi_slam
