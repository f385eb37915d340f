// SPDX-License-Identifier: BSD-3-Clause
// One run of the Freiburg benchmark: a log mapped once with one matcher of loops and one seed, and its path
// held against the true relations (R. Kuemmerle et al., "On Measuring the Accuracy of SLAM Algorithms",
// 2009).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "batch/run_figures.h"
#include "session/settings.h"

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

struct FreiburgFigures : RunFigures {
  std::size_t loops_accepted = 0;
  std::size_t loops_judged = 0;       ///< of those, the ones of which a true relation speaks,
  std::size_t loops_false = 0;        ///< and of those, the ones that it contradicts: see loop_judgement.h
  std::optional<double> loop_recall;  ///< none when no relation joins two passes of a place
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
