// SPDX-License-Identifier: BSD-3-Clause
// One run of the Freiburg benchmark: a log mapped once with one matcher of loops and one seed, and its path
// held against the true relations (R. Kuemmerle et al., "On Measuring the Accuracy of SLAM Algorithms",
// 2009).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "psi_slam/results/relations_metric.h"
#include "psi_slam/session/settings.h"

namespace psi_slam {

struct FreiburgRun {
  std::filesystem::path log;
  std::filesystem::path ini;
  std::filesystem::path relations;
  std::string matcher;  ///< one of freiburg_matchers()
  std::uint64_t seed = 1;
  int threads = 1;
};

/// "csm", "csm_ga", "ga", "adaptive" as loop_closure.matcher has them; "adaptive_paper" is adaptive with the
/// genetic search of the paper.
const std::vector<std::string>& freiburg_matchers();

/// False for csm: it searches exhaustively, and nothing else in a run draws random numbers.
bool draws_random_numbers(const std::string& matcher);

/// The defaults, the log's own file, and what the run sets. Throws UserError as benchmark_settings().
Settings settings_of(const FreiburgRun& run);

/// Every setting, "section.key = value" a line: equal texts are equal settings.
std::string settings_text(const Settings& settings);

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

PathErrors path_errors(const RelationsMetric& metric);

struct FreiburgFigures {
  PathErrors errors;
  std::size_t relations_used = 0;
  std::size_t relations_skipped = 0;
  std::size_t scans = 0;
  double duration_s = 0;  ///< of the recording
  std::size_t loops_accepted = 0;
  std::size_t loops_judged = 0;       ///< of those, the ones of which a true relation speaks,
  std::size_t loops_false = 0;        ///< and of those, the ones that it contradicts: see loop_judgement.h
  std::optional<double> loop_recall;  ///< none when no relation joins two passes of a place

  // Of the whole process, from its start to its end; 0 until it is measured.
  double wall_s = 0;
  double cpu_s = 0;
  double peak_memory_mib = 0;

  /// Seconds of the recording in a second of work.
  double real_time_factor() const { return wall_s > 0 ? duration_s / wall_s : 0; }
};

/// Maps and evaluates; no map is drawn and no file written. Throws UserError as MappingSession and
/// evaluate_relations() do, and when the log breaks off: figures of a part of it would not be the
/// benchmark's.
FreiburgFigures map_and_evaluate(const FreiburgRun& run);

/// The figures as JSON text of one line, which reads back to the same figures.
std::string figures_json(const FreiburgFigures& figures);

/// None where the text is not what figures_json() writes.
std::optional<FreiburgFigures> read_figures(const std::string& json);

}  // namespace psi_slam
