// SPDX-License-Identifier: BSD-3-Clause
// Maps simulated buildings with sensors of different beam spacing and maximum range, and with different steps
// between scans, to show that the default settings hold for all of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "batch/workers.h"
#include "session/settings.h"

namespace psi_slam {

struct SensorSweepOptions {
  std::vector<double> max_ranges_m = {8, 30, 80};
  std::vector<double> spacings_deg = {0.25, 0.5, 1, 2};
  /// Steps between scans, ascending. At the first one, each simulated scan is kept.
  std::vector<double> steps_m = {0.05, 0.25, 0.5, 1};
  double path_m = 120;     ///< in a building for a range of 8 m; grows with the building
  std::uint64_t seed = 1;  ///< of the buildings, paths and noise
  int threads = 1;         ///< runs at a time; results do not depend on it
};

struct SensorSweepRow {
  double max_range_m = 0;
  double spacing_deg = 0;
  double step_m = 0;
  double path_m = 0;
  std::size_t scans = 0;
  std::size_t unmatched = 0;  ///< scans that the front end could not match, except the first
  double error_m = 0;         ///< relations metric over random pairs of scans
  double error_deg = 0;
  std::size_t loops = 0;        ///< in the finished graph
  std::size_t false_loops = 0;  ///< of these, loops that contradict the truth
};

/// Factor of all lengths of the building for a sensor: 1 for a range of 8 m or less, growing with the square
/// root of the range.
double building_scale(double max_range_m);

/// Maps the same run of the same building with each spacing and step. The field of view is 180 degrees.
/// `settings` are those of each run, with one thread. Rows are by range, then spacing, then step.
std::vector<SensorSweepRow> run_sensor_sweep(const SensorSweepOptions& options, const Settings& settings,
                                             const ProgressObserver& observer);

}  // namespace psi_slam
