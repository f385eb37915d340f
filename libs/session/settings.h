// SPDX-License-Identifier: BSD-3-Clause
// All settings of psi-slam. Settings files, --set, dumps, the reference page and the window's settings panel
// are all made from describe(), which alone describes the options.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/config/option_table.h"
#include "localization/localizer_options.h"
#include "map/exports/map_files.h"
#include "mapping/mapper_options.h"
#include "psi_slam/grid_map.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// Pose of the laser on the robot. Coordinates that the user does not state are empty.
struct LaserMount {
  std::optional<double> x_m;
  std::optional<double> y_m;
  std::optional<double> yaw_rad;
};

struct RunOptions {
  std::uint64_t seed = 1;  ///< seed of all random numbers
  int threads = 0;         ///< number of threads; 0: one for each processor. Results do not depend on it.
};

/// Results while the robot drives.
struct LiveOptions {
  double map_period_s = 5;        ///< time between two writings of the map; 0: only at the end
  double journal_period_s = 0.5;  ///< time between two chunks of the journal
};

/// Frame of the exported map.
struct MapFrameOptions {
  static constexpr const char* kNone = "none";
  static constexpr const char* kWalls = "walls";

  /// kNone: the frame of the mapper. kWalls: most walls are parallel to the axes, after a turn of at most 45
  /// degrees. Otherwise the angle in degrees by which the map is turned counter-clockwise.
  std::string align = kNone;
  double origin_x_m = 0;  ///< point of the turned map that becomes the origin
  double origin_y_m = 0;
};

/// A map known before the run, with which the run is aligned.
struct PriorOptions {
  std::string map;                        ///< file of the prior map; empty: none
  double sigma_m = 0.05;                  ///< standard deviation of its walls
  bool extend = false;                    ///< whether the exported map is the prior map, brought up to date
  std::optional<double> metres_per_unit;  ///< unit of a DXF drawing; empty: as the drawing states
  std::string layers;                     ///< layers of a DXF drawing with walls; empty: all
};

struct Settings {
  LogOptions log;  ///< without robot_T_laser: log_options() takes it from `laser_mount`
  LaserMount laser_mount;
  MapperOptions mapper;  ///< without seed and threads: mapper_options() takes them from `run`
  GridMapOptions map;
  MapFileOptions map_files;
  MapFrameOptions map_frame;
  PriorOptions prior;
  /// Without the options that localizer_options() takes from `mapper` and `run`.
  LocalizerOptions localization;
  LiveOptions live;
  RunOptions run;
};

/// Describes every option once, bound to the members of `settings`, and the old names of renamed options.
/// `settings` must hold its defaults and outlive the table. Angles are in degrees in the table, in radians in
/// the members.
void describe(OptionTable& table, Settings& settings);

/// Parts of describe(): the sections from [front_end] to [joint_refinement], and [localization].
void describe_mapper(OptionTable& table, MapperOptions& mapper);
void describe_localization(OptionTable& table, LocalizerOptions& localization);

/// Settings, together with the option table that is bound to them.
struct BoundSettings {
  BoundSettings() { describe(table, settings); }
  BoundSettings(const BoundSettings&) = delete;
  BoundSettings& operator=(const BoundSettings&) = delete;

  /// Takes the values of the file `config`, unless that path is empty. Then takes "section.key=value"
  /// assignments in their order. Throws UserError for a file that is unreadable, and for options and values
  /// that are not accepted. Call check() afterwards. Old names leave warnings in the table (see
  /// OptionTable::take_warnings()).
  void load(const std::filesystem::path& config, const std::vector<std::string>& assignments);

  Settings settings;
  OptionTable table;
};

/// Returns the text of a settings file with all options and their current values, under a heading with the
/// program's version.
std::string settings_file_text(const OptionTable& table);
std::string settings_file_text(const Settings& settings);

/// Throws UserError if two options contradict each other. Each single option is checked when it is set.
void check(const Settings& settings);

/// Makes all checks of check() except that of map.epsg, which needs GDAL.
void check_values(const Settings& settings);

/// Returns the options of the log's reader. If only some coordinates of the laser's mount are set, the others
/// are 0.
LogOptions log_options(const Settings& settings);

/// Returns the options of the mapper, with the seed and the threads of `settings.run`.
MapperOptions mapper_options(const Settings& settings);

/// Returns the options of the localizer. Takes front end, consensus, loop matcher, genetic search and
/// smoothing from `settings.mapper`, and the seed from `settings.run`.
LocalizerOptions localizer_options(const Settings& settings);

/// Returns the number of threads to start for run.threads, at least 1.
int worker_threads(const RunOptions& run);

}  // namespace psi_slam
