// SPDX-License-Identifier: BSD-3-Clause
// One run of the Freiburg benchmark: maps a log once with one matcher and one seed, and evaluates the path
// against the true relations (R. Kümmerle et al., "On measuring the accuracy of SLAM algorithms", 2009).
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

/// "csm", "csm_ga", "ga" and "adaptive", the values of loop_closure.matcher, and "adaptive_paper": the
/// adaptive matcher with the genetic search of the paper.
const std::vector<std::string>& freiburg_matchers();

/// False for csm, which searches exhaustively. No other part of a run draws random numbers.
bool draws_random_numbers(const std::string& matcher);

/// The defaults, overridden by the log's own settings and by those of the run. Throws UserError as
/// benchmark_settings().
Settings settings_of(const FreiburgRun& run);

/// All settings, with a line "section.key = value" for each. Equal texts mean equal settings.
std::string settings_text(const Settings& settings);

struct FreiburgFigures : RunFigures {
  std::size_t loops_accepted = 0;
  std::size_t loops_judged = 0;       ///< accepted loops that a true relation can judge: see loop_judgement.h
  std::size_t loops_false = 0;        ///< judged loops that contradict the relation
  std::optional<double> loop_recall;  ///< empty if no relation connects two passes of one place

  /// Calls visit(key, member) for each figure of the loops but the recall.
  template <class Figures, class Visit>
  static void visit_loops(Figures& figures, const Visit& visit) {
    visit("loops_accepted", figures.loops_accepted);
    visit("loops_judged", figures.loops_judged);
    visit("loops_false", figures.loops_false);
  }
};

/// Maps the log and evaluates its path, without drawing a map or writing files. Throws UserError as
/// MappingSession and evaluate_relations(), and when the log ends early: figures of a part would not be
/// comparable.
FreiburgFigures map_and_evaluate(const FreiburgRun& run);

/// The figures as one line of JSON, for read_figures().
std::string figures_json(const FreiburgFigures& figures);

/// Reads the text of figures_json(). Empty for other text.
std::optional<FreiburgFigures> read_figures(const std::string& json);

}  // namespace psi_slam
