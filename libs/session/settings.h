// SPDX-License-Identifier: BSD-3-Clause
// All settings of psi-slam. describe() is their only description: settings files, --set, dumps, the reference
// page and the window's settings panel are made from it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "config/option_table.h"
#include "exports/map_files.h"
#include "localization/localizer_options.h"
#include "mapping/mapper_options.h"
#include "psi_slam/grid_map.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// Pose of the laser on the robot, as far as the user states it.
struct LaserMount {
  std::optional<double> x_m;
  std::optional<double> y_m;
  std::optional<double> yaw_rad;
};

struct RunOptions {
  std::uint64_t seed = 1;  ///< of all random numbers
  int threads = 0;         ///< 0: one for each processor. Results do not depend on it.
};

struct Settings {
  LogOptions log;  ///< without robot_T_laser, which log_options() takes from `laser_mount`
  LaserMount laser_mount;
  MapperOptions mapper;  ///< without seed and threads, which mapper_options() takes from `run`
  GridMapOptions map;
  MapFileOptions map_files;
  LocalizerOptions localization;  ///< without what localizer_options() takes from `mapper` and `run`
  RunOptions run;
};

/// Describes every option once, bound to the members of `settings`, and the old names of renamed options.
/// `settings` must hold its defaults and outlive the table. Angles are in degrees in the table, in radians in
/// the members.
void describe(OptionTable& table, Settings& settings);

/// Parts of describe(): the sections from [front_end] to [joint_refinement], and [localization].
void describe_mapper(OptionTable& table, MapperOptions& mapper);
void describe_localization(OptionTable& table, LocalizerOptions& localization);

/// Settings together with the table that is bound to them.
struct BoundSettings {
  BoundSettings() { describe(table, settings); }
  BoundSettings(const BoundSettings&) = delete;
  BoundSettings& operator=(const BoundSettings&) = delete;

  /// Takes the values of a file, unless `config` is empty, and then "section.key=value" assignments in their
  /// order. Throws UserError for what is unreadable or not accepted. Call check() afterwards. Old names leave
  /// warnings in the table (see OptionTable::take_warnings()).
  void load(const std::filesystem::path& config, const std::vector<std::string>& assignments);

  Settings settings;
  OptionTable table;
};

/// Text of a settings file with all options and their present values, under a heading with the program's
/// version.
std::string settings_file_text(const OptionTable& table);
std::string settings_file_text(const Settings& settings);

/// Throws UserError if two options contradict each other. Each single option is checked when it is set.
void check(const Settings& settings);

/// check() without the coordinate system map.epsg, which only GDAL knows.
void check_values(const Settings& settings);

/// Options of the log's reader. If the laser's mount is stated in part, the rest of it is 0.
LogOptions log_options(const Settings& settings);

/// Options of the mapper, with seed and threads of `run`.
MapperOptions mapper_options(const Settings& settings);

/// Options of the localizer, with the mapper's front end, consensus and genetic search, and the seed of
/// `run`.
LocalizerOptions localizer_options(const Settings& settings);

/// Number of threads that run.threads means, at least 1.
int worker_threads(const RunOptions& run);

}  // namespace psi_slam
