// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Settings of the whole library by name, as in a settings file (.ini).
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace psi_slam {

struct GridMapOptions;
struct LocalizerOptions;
struct LogOptions;
struct MapperOptions;
struct Settings;

/// All settings of psi-slam: by default, from settings files, and changed one by one.
///
///     psi_slam::Configuration configuration;
///     configuration.load("my.ini");
///     configuration.set("map.resolution_m", "0.1");
///     psi_slam::MappingSession session("my.log", configuration);
///
/// Pass it wherever the library expects options: MappingSession, Mapper, Localizer, open_log() and
/// draw_grid_map() take their part of it. The manual page psi-slam.ini(5) lists all options with units,
/// ranges and defaults.
class Configuration {
 public:
  /// Every option has its default.
  Configuration();
  /// Copies all values.
  Configuration(const Configuration& other);
  /// Copies all values.
  Configuration& operator=(const Configuration& other);
  ~Configuration();

  /// Takes the values of a settings file; other options keep theirs. Throws UserError with file and line for
  /// an unknown section or key and for a value that its option does not accept. Then nothing has changed.
  void load(const std::filesystem::path& ini);

  /// Gives one option a value: set("map.resolution_m", "0.1"). Angles are in degrees, "auto" and "true" are
  /// written as in a file. Throws UserError if there is no such option (with the nearest name), or if it does
  /// not accept the value. Then nothing has changed.
  void set(std::string_view name, std::string_view value);

  /// Returns the present value of an option as text. Throws UserError if there is no such option.
  std::string value(std::string_view name) const;

  /// Returns a settings file of all options with help, unit, range, default and present value. Loading it
  /// restores the present values exactly.
  std::string text() const;

  /// Returns one sentence without full stop for each old name of an option that was used so far.
  const std::vector<std::string>& warnings() const;

  /// Throws UserError if two options contradict each other.
  void check() const;

  /// Returns a copy of the options of Mapper, for CMetricMapBuilderPsi::Options. Throws like check().
  std::shared_ptr<const MapperOptions> mapper_options() const;

  /// Returns all settings, unchecked: MappingSession checks them.
  operator const Settings&() const;
  /// Returns the options of Mapper. Throws like check().
  operator const MapperOptions&() const;
  /// Returns the options of Localizer. Throws like check().
  operator const LocalizerOptions&() const;
  /// Returns the options of open_log(). Throws like check().
  operator const LogOptions&() const;
  /// Returns the options of draw_grid_map(). Throws like check().
  operator const GridMapOptions&() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace psi_slam
