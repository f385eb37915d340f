// SPDX-License-Identifier: BSD-3-Clause
// Figures of one run of a mapper on a log: the errors of its path against the true relations, time and
// memory.
#pragma once

#include <array>
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "map/trajectory/relations_metric.h"

namespace psi_slam {

struct MeanAndStd {
  double mean = 0;
  double std = 0;  ///< standard deviation of the population
};

/// Mean and standard deviation with four decimals: "0.0200 ± 0.0150".
std::string errors_text(const MeanAndStd& errors);

/// Errors of a path over the true relations, and their squares.
struct PathErrors {
  MeanAndStd translation_abs_m;
  MeanAndStd translation_sq_m2;
  MeanAndStd rotation_abs_deg;
  MeanAndStd rotation_sq_deg2;
  /// Translation error as Cartographer's evaluation tool defines it: see relations_metric.h.
  MeanAndStd cartographer_translation_abs_m;
};

/// Names of one member of PathErrors: `key` in JSON, `name` in tables.
struct PathFigure {
  const char* key;
  const char* name;
  MeanAndStd PathErrors::*errors;
};

/// The four errors that the paper reports, in the paper's order, then Cartographer's variant of the first.
inline constexpr std::size_t kPaperFigures = 4;
inline constexpr std::array<PathFigure, kPaperFigures + 1> kPathFigures{
    {{"translation_abs_m", "translation [m]", &PathErrors::translation_abs_m},
     {"translation_sq_m2", "translation² [m²]", &PathErrors::translation_sq_m2},
     {"rotation_abs_deg", "rotation [deg]", &PathErrors::rotation_abs_deg},
     {"rotation_sq_deg2", "rotation² [deg²]", &PathErrors::rotation_sq_deg2},
     {"cartographer_translation_abs_m", "translation, Cartographer's variant [m]",
      &PathErrors::cartographer_translation_abs_m}}};

struct RunFigures {
  PathErrors errors;
  std::size_t relations_used = 0;
  std::size_t relations_skipped = 0;
  std::size_t scans = 0;
  double duration_s = 0;  ///< length of the recording

  // Time and memory of the whole process, from its start to its end; 0 until measured.
  double wall_s = 0;
  double cpu_s = 0;
  double peak_memory_mib = 0;

  /// Length of the recording divided by the wall time; 0 until measured.
  double real_time_factor() const { return wall_s > 0 ? duration_s / wall_s : 0; }
};

/// Computes the errors of a path over known relations; wall time, processor time and memory stay 0. Throws
/// the errors of evaluate_relations().
RunFigures evaluate_path(const Trajectory& path, const std::vector<Relation>& relations);

/// JSON object with a member for each figure.
nlohmann::ordered_json run_figures_json(const RunFigures& figures);

/// Reads a JSON object of run_figures_json() and restores every figure exactly. Throws
/// nlohmann::json::exception for a missing figure.
RunFigures read_run_figures(const nlohmann::ordered_json& json);

/// Copies the times and the memory of a process, such as a ChildEnd, to the figures of its run.
template <class End>
void set_effort(RunFigures& figures, const End& end) {
  figures.wall_s = end.wall_s;
  figures.cpu_s = end.cpu_s;
  figures.peak_memory_mib = end.peak_memory_mib;
}

}  // namespace psi_slam
