// SPDX-License-Identifier: BSD-3-Clause
// Every setting of a mapping run, and its one description: settings files, --set, dumps, the reference and
// the views of the GUI all come from describe().
#pragma once

#include <cstdint>
#include <optional>

#include "config/option_table.h"
#include "psi_slam/localizer.h"
#include "psi_slam/log_options.h"
#include "mapping/mapper_options.h"
#include "psi_slam/grid_map.h"
#include "exports/map_files.h"

namespace psi_slam {

/// The laser's pose on the robot, as far as the user states it.
struct LaserMount {
  std::optional<double> x_m;
  std::optional<double> y_m;
  std::optional<double> yaw_rad;
};

struct RunOptions {
  std::uint64_t seed = 1;  ///< of all random numbers
  int threads = 0;         ///< 0: as many as the machine has processors; no result depends on it
};

struct Settings {
  LogOptions log;  ///< its robot_T_laser is left empty: `laser_mount` stands for it
  LaserMount laser_mount;
  MapperOptions mapper;  ///< its seed and threads are those of `run`: see mapper_options()
  GridMapOptions map;
  MapFileOptions map_files;
  LocalizerOptions localization;  ///< what it shares with mapping is the mapper's: see localizer_options()
  RunOptions run;
};

/// Describes every option once, bound to the members of `settings`, which must hold their defaults and
/// outlive the table. Angles are degrees in the table and radians in the members.
void describe(OptionTable& table, Settings& settings);

/// Throws UserError, one sentence, when two options contradict each other. (Each alone is checked when it is
/// set.)
void check(const Settings& settings);

/// What the reader of the log takes. Where the mount is stated in part, the rest of it is 0.
LogOptions log_options(const Settings& settings);

/// What the mapper takes: with the seed and the threads of `run`.
MapperOptions mapper_options(const Settings& settings);

/// What the localizer takes: with the mapper's front end and genetic search, and the seed of `run`.
LocalizerOptions localizer_options(const Settings& settings);

/// The number of threads that run.threads stands for, at least 1.
int worker_threads(const RunOptions& run);

}  // namespace psi_slam
