// SPDX-License-Identifier: BSD-3-Clause
// What a sweep came to, as the tables that its pages show.
#pragma once

#include <string>
#include <vector>

#include "batch/sweep.h"

namespace psi_slam {

struct SweepCell {
  std::string text;
  bool best = false;
};

struct SweepTable {
  std::string title;
  std::vector<std::string> heads;
  std::size_t words = 0;  ///< so many columns from the left are texts; the others numbers
  std::vector<std::vector<SweepCell>> rows;
};

/// Over the seeds, a row for each log and setting: errors and loops, mean ± standard deviation. Of each log
/// the setting with the smallest mean error is marked, where there are several.
SweepTable results_table(const SweepPlan& plan, const SweepResult& result);

/// The same rows: times and memory.
SweepTable times_table(const SweepPlan& plan, const SweepResult& result);

/// The runs that failed, and why; without rows where none did.
SweepTable failures_table(const SweepPlan& plan, const SweepResult& result);

}  // namespace psi_slam
