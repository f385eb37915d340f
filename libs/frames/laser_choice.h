// SPDX-License-Identifier: BSD-3-Clause
// Which lasers of a log the user selects, and where the user says they are mounted.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "frames/log_format.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// Value of an option such as `log.laser`: the format's usual laser, one laser by name, several names
/// separated by commas, or "all". Scans of the first of several lasers open frames.
struct LaserChoice {
  bool all = false;
  std::vector<std::string> names;  ///< empty: all lasers, or the usual one

  bool several() const { return all || names.size() > 1; }
};

/// Throws UserError that names the option if a name is empty or repeated.
LaserChoice laser_choice(std::string_view option, std::string_view value);

/// Returns whether frames of a log of this format may hold scans of several lasers. `scan_topic` overrides
/// `laser`, but only for bags. Throws UserError if several lasers are selected and `robot_T_laser` is stated,
/// and for values that laser_choice() rejects.
bool reads_several_lasers(const LogOptions& options, LogFormat format);

/// Numbers the lasers of a log in which each scan names its laser; see LaserScan::laser. Listed lasers have
/// the order of the user's list. "all" has the order of their first scans. Otherwise only the first laser is
/// read.
class ChosenLasers {
 public:
  explicit ChosenLasers(LaserChoice choice) : choice_(std::move(choice)) {}

  /// Returns the number of a laser, or nothing if it is not read. The call may add a new laser.
  std::optional<std::size_t> number_of(const std::string& name);

  /// Names of the lasers that are read: the listed ones, otherwise those that have appeared.
  std::vector<std::string> names() const;

 private:
  LaserChoice choice_;
  std::map<std::string, std::size_t> numbers_;
};

/// Pose of one laser on the robot as the user states it.
struct StatedMount {
  std::string name;
  mrpt::math::TPose2D robot_T_laser;
  bool mirrored = false;
};

/// Parses `LogOptions::laser_mounts`. Throws UserError that says what was expected.
std::vector<StatedMount> stated_mounts(const LogOptions& options);

/// Options for the laser that has any of these names, with its stated mount if there is one.
LogOptions options_of_laser(const LogOptions& options, const std::vector<std::string>& names);

bool contains(const std::vector<std::string>& names, const std::string& name);

/// Names for a message: "a", "b".
std::string quoted_list(const std::vector<std::string>& names);

}  // namespace psi_slam
