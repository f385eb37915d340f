// SPDX-License-Identifier: BSD-3-Clause
// Maps simulated buildings with sensors of different beam spacing and maximum range, and with different steps
// between scans. Shows how well the default settings suit these sensors.
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
  /// Steps between scans, ascending. At the first step, every simulated scan is kept.
  std::vector<double> steps_m = {0.05, 0.25, 0.5, 1};
  double path_m = 120;     ///< length of the path for a range of 8 m; grows with the building
  std::uint64_t seed = 1;  ///< seed of buildings, paths and noise
  int threads = 1;         ///< number of sensors simulated at a time; results do not depend on it
};

struct SensorSweepRow {
  double max_range_m = 0;
  double spacing_deg = 0;
  double step_m = 0;
  double path_m = 0;
  std::size_t scans = 0;
  std::size_t unmatched = 0;  ///< scans after the first that the front end could not match
  double error_m = 0;         ///< mean error over relations between random pairs of scans
  double error_deg = 0;
  std::size_t loops = 0;        ///< accepted loops
  std::size_t false_loops = 0;  ///< accepted loops that contradict the truth
};

/// Factor of all lengths of the building for a sensor: 1 for a range of 8 m or less, growing with the square
/// root of the range.
double building_scale(double max_range_m);

/// Simulates one run for each range and spacing, and maps it with each step. The field of view is 180
/// degrees. Each run uses `settings` with one thread. Rows are ordered by range, then spacing, then step.
std::vector<SensorSweepRow> run_sensor_sweep(const SensorSweepOptions& options, const Settings& settings,
                                             const ProgressObserver& observer);

}  // namespace psi_slam
