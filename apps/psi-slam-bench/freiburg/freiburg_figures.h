// SPDX-License-Identifier: BSD-3-Clause
// Figures of one log with one matcher over all seeds: means and spreads, not the best run.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "batch/seeds.h"
#include "freiburg/freiburg_benchmark.h"

namespace psi_slam {

struct CellFigures {
  std::size_t runs = 0;    ///< successful runs
  std::size_t failed = 0;  ///< failed runs
  PathErrors errors;       ///< means and standard deviations of the runs, averaged over the seeds
  std::array<SeedSpread, kPathFigures.size()> spread;  ///< of the mean errors, in the order of kPathFigures
  double relations_used = 0;                           ///< mean over the seeds
  double relations_skipped = 0;
  SeedSpread loops_accepted;
  SeedSpread loops_judged;
  SeedSpread loops_false;
  std::optional<SeedSpread> loop_recall;  ///< of the runs that have a recall; may be empty
  SeedSpread wall_s;
  SeedSpread cpu_s;
  SeedSpread real_time_factor;
  SeedSpread peak_memory_mib;
};

/// Empty if every run failed.
std::optional<CellFigures> figures_of(const FreiburgCell& cell);

}  // namespace psi_slam
