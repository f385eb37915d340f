// SPDX-License-Identifier: BSD-3-Clause
// What the runs of one log with one matcher come to over the seeds: the mean and how far they spread, never
// the best one.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "freiburg_benchmark.h"

namespace psi_slam {

struct SeedSpread {
  std::size_t count = 0;  ///< of the values
  double mean = 0;
  double std = 0;  ///< of a sample: divided by n - 1; 0 of one value, which does not spread
  double min = 0;
  double max = 0;
};

/// All 0 where there are no values.
SeedSpread spread_of(const std::vector<double>& values);

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
