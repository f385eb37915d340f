// SPDX-License-Identifier: BSD-3-Clause
#include "freiburg/freiburg_figures.h"

namespace psi_slam {

namespace {

std::optional<SeedSpread> recall_of(const std::vector<FreiburgFigures>& runs) {
  std::vector<double> recalls;
  for (const FreiburgFigures& run : runs)
    if (run.loop_recall) recalls.push_back(*run.loop_recall);
  if (recalls.empty()) return std::nullopt;
  return spread_of(recalls);
}

}  // namespace

std::optional<CellFigures> figures_of(const FreiburgCell& cell) {
  std::vector<FreiburgFigures> runs;
  for (const FreiburgResult& run : cell.runs)
    if (run.figures) runs.push_back(*run.figures);
  if (runs.empty()) return std::nullopt;
  const auto over_seeds = [&runs](const auto& value_of) { return spread_over(runs, value_of); };
  CellFigures figures;
  figures.runs = runs.size();
  figures.failed = cell.runs.size() - runs.size();
  for (std::size_t i = 0; i < kPathFigures.size(); ++i) {
    const auto errors = kPathFigures[i].errors;
    figures.spread[i] = over_seeds([&](const FreiburgFigures& run) { return (run.errors.*errors).mean; });
    figures.errors.*errors = {figures.spread[i].mean, over_seeds([&](const FreiburgFigures& run) {
                                                        return (run.errors.*errors).std;
                                                      }).mean};
  }
  figures.relations_used = over_seeds([](const FreiburgFigures& run) { return run.relations_used; }).mean;
  figures.relations_skipped =
      over_seeds([](const FreiburgFigures& run) { return run.relations_skipped; }).mean;
  figures.loops_accepted = over_seeds([](const FreiburgFigures& run) { return run.loops_accepted; });
  figures.loops_judged = over_seeds([](const FreiburgFigures& run) { return run.loops_judged; });
  figures.loops_false = over_seeds([](const FreiburgFigures& run) { return run.loops_false; });
  figures.loop_recall = recall_of(runs);
  figures.wall_s = over_seeds([](const FreiburgFigures& run) { return run.wall_s; });
  figures.cpu_s = over_seeds([](const FreiburgFigures& run) { return run.cpu_s; });
  figures.real_time_factor = over_seeds([](const FreiburgFigures& run) { return run.real_time_factor(); });
  figures.peak_memory_mib = over_seeds([](const FreiburgFigures& run) { return run.peak_memory_mib; });
  return figures;
}

}  // namespace psi_slam
