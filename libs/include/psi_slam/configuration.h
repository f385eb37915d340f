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

/// Holds all settings of psi-slam. Every option starts with its default; load() and set() change values.
///
///     psi_slam::Configuration configuration;
///     configuration.load("my.ini");
///     configuration.set("map.resolution_m", "0.1");
///     psi_slam::MappingSession session("my.log", configuration);
///
/// Pass a Configuration wherever the library expects options: MappingSession, Mapper, Localizer, open_log()
/// and draw_grid_map() each read the options that they need. The manual page psi-slam.ini(5) lists all
/// options with units, ranges and defaults.
class Configuration {
 public:
  /// Sets every option to its default.
  Configuration();
  /// Copies all values.
  Configuration(const Configuration& other);
  /// Copies all values.
  Configuration& operator=(const Configuration& other);
  ~Configuration();

  /// Loads the values of a settings file. Options that the file does not name keep their values. Throws
  /// UserError with file and line for an unknown section or key, and for a value that its option does not
  /// accept. After an error, all options keep their values.
  void load(const std::filesystem::path& ini);

  /// Sets one option: set("map.resolution_m", "0.1"). Write the value as in a settings file: angles in
  /// degrees, "auto", "true". Programs of research set the constants of the method in the same way; settings
  /// files cannot. Throws UserError if the option does not accept the value, or does not exist;
  /// the message then suggests the nearest name. After an error, all options keep their values.
  void set(std::string_view name, std::string_view value);

  /// Returns the current value of an option or constant as text. Throws UserError if it does not exist.
  std::string value(std::string_view name) const;

  /// Returns the text of a settings file with all options: help, unit, range, default and current value.
  /// Loading this text restores the values of all options exactly. It also states changed constants, which
  /// load() ignores with a warning.
  std::string text() const;

  /// Returns one warning, a sentence without full stop, for each outdated option name used so far.
  const std::vector<std::string>& warnings() const;

  /// Checks that no two options contradict each other. Throws UserError if they do.
  void check() const;

  /// Returns a copy of the options of Mapper, for CMetricMapBuilderPsi::Options. Throws like check().
  std::shared_ptr<const MapperOptions> mapper_options() const;

  /// Returns all settings, unchecked: MappingSession checks them. The references stay valid as long as the
  /// object.
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
