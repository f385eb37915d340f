// SPDX-License-Identifier: BSD-3-Clause
// What one run of a mapper on a log comes to, whoever wrote the mapper: how far its path is from the true
// relations, and what it took.
#pragma once

#include <array>
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "evaluation/relations_metric.h"

namespace psi_slam {

struct MeanAndStd {
  double mean = 0;
  double std = 0;  ///< of the population
};

/// Over the relations.
struct PathErrors {
  MeanAndStd translation_abs_m;
  MeanAndStd translation_sq_m2;
  MeanAndStd rotation_abs_deg;
  MeanAndStd rotation_sq_deg2;
  MeanAndStd cartographer_translation_abs_m;  ///< the variant of Cartographer's tool: see relations_metric.h
};

/// How one of them is named in tables and files.
struct PathFigure {
  const char* key;
  const char* name;
  MeanAndStd PathErrors::*errors;
};

/// The four that the paper reports, in its order, and Cartographer's variant of the first.
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
  double duration_s = 0;  ///< of the recording

  // Of the whole process, from its start to its end; 0 until it is measured.
  double wall_s = 0;
  double cpu_s = 0;
  double peak_memory_mib = 0;

  /// Seconds of the recording in a second of work.
  double real_time_factor() const { return wall_s > 0 ? duration_s / wall_s : 0; }
};

/// Holds a path against the true relations; what it took is not measured yet. Throws UserError as
/// evaluate_relations().
RunFigures evaluate_path(const Trajectory& path, const std::vector<Relation>& relations);

/// An object with a member for each figure.
nlohmann::ordered_json run_figures_json(const RunFigures& figures);

/// The same figures again, to the last bit. Throws nlohmann::json::exception where they are not there.
RunFigures read_run_figures(const nlohmann::ordered_json& json);

}  // namespace psi_slam
