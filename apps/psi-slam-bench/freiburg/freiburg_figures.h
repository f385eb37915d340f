// SPDX-License-Identifier: BSD-3-Clause
// What the runs of one log with one matcher come to over the seeds: the mean and how far they spread, never
// the best one.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "freiburg/freiburg_benchmark.h"
#include "batch/seed_spread.h"

namespace psi_slam {

struct CellFigures {
  std::size_t runs = 0;    ///< that did not fail
  std::size_t failed = 0;  ///< that did
  PathErrors errors;       ///< means over the seeds, of the means and of the standard deviations
  std::array<SeedSpread, kPathFigures.size()> spread;  ///< of the means, in the order of kPathFigures
  double relations_used = 0;                           ///< means over the seeds, all that follow
  double relations_skipped = 0;
  SeedSpread loops_accepted;
  SeedSpread loops_judged;
  SeedSpread loops_false;
  std::optional<SeedSpread> loop_recall;  ///< of the runs that have one; none when no run has
  SeedSpread wall_s;
  SeedSpread cpu_s;
  SeedSpread real_time_factor;
  SeedSpread peak_memory_mib;
};

/// None when every run failed.
std::optional<CellFigures> figures_of(const FreiburgCell& cell);

}  // namespace psi_slam
