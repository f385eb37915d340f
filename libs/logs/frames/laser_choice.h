// SPDX-License-Identifier: BSD-3-Clause
// Lasers of a log that the user selects, and mounts of lasers that the user states.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "logs/frames/log_format.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// Value of an option such as `log.laser`: the usual laser of the format, one laser by name, several names
/// separated by commas, or "all". Scans of the first of several lasers open frames.
struct LaserChoice {
  bool all = false;
  std::vector<std::string> names;  ///< names of the selected lasers; empty: all lasers, or the usual one

  bool several() const { return all || names.size() > 1; }
};

/// Parses the value of an option. Throws UserError that names the option if a name is empty or repeated.
LaserChoice laser_choice(std::string_view option, std::string_view value);

/// Returns whether frames of a log of this format may hold scans of several lasers. `scan_topic` overrides
/// `laser`, but only for bags. Throws UserError if several lasers are selected and `robot_T_laser` is stated,
/// and for values that laser_choice() rejects.
bool reads_several_lasers(const LogOptions& options, LogFormat format);

/// Numbers the lasers of a log in which each scan names its laser; see LaserScan::laser. Listed lasers have
/// the order of the user's list. With "all", lasers have the order of their first scans. Otherwise only the
/// first laser of the log is read.
class ChosenLasers {
 public:
  explicit ChosenLasers(LaserChoice choice) : choice_(std::move(choice)) {}

  /// Returns the number of a laser, or nothing if it is not read. The call may add a new laser.
  std::optional<std::size_t> number_of(const std::string& name);

  /// Names of the lasers that are read: all listed lasers, or without a list the lasers that have appeared so
  /// far.
  std::vector<std::string> names() const;

 private:
  LaserChoice choice_;
  std::map<std::string, std::size_t> numbers_;
};

/// Says which lasers of a log are combined and which are left out if the user selects none; the first of
/// `combined` opens frames. Empty for a single laser.
std::string choice_of_lasers(const std::vector<std::string>& combined,
                             const std::vector<std::string>& left_out);

/// Says that no scan of a laser which `option` names came while a stream was looked over.
std::string late_laser_text(const std::string& option, const std::string& name);

/// Pose of one laser on the robot as the user states it.
struct StatedMount {
  std::string name;
  mrpt::math::TPose2D robot_T_laser;
  bool mirrored = false;
};

/// Parses `LogOptions::laser_mounts`. Throws UserError that says what was expected.
std::vector<StatedMount> stated_mounts(const LogOptions& options);

/// Largest delay of scans, and largest amount of a negative delay. Clocks that were not synchronised differ
/// by minutes.
inline constexpr double kMostScanDelay_s = 600;

/// Delay of the scans of one laser as the user states it.
struct StatedDelay {
  std::string name;  ///< empty: the delay of all lasers
  double delay_s = 0;
};

/// Parses `LogOptions::scan_delay_s`. Empty for "auto". Throws UserError that says what was expected.
std::vector<StatedDelay> stated_delays(const LogOptions& options);

/// Returns the delay of a laser that any of these names denotes; 0 if none is stated.
double delay_of_laser(const std::vector<StatedDelay>& delays, const std::vector<std::string>& names);

/// Text of `LogOptions::scan_delay_s` that stated_delays() reads as exactly these delays.
std::string scan_delay_text(const std::vector<StatedDelay>& delays);

/// Lasers that the user names to state a mount or a delay: the option, and the name of the laser.
std::vector<std::pair<const char*, std::string>> lasers_with_stated_values(const LogOptions& options);

/// Returns the options of a laser that any of these names denotes, including its stated mount and delay if
/// there are any.
LogOptions options_of_laser(const LogOptions& options, const std::vector<std::string>& names);

/// Returns whether an option such as log.laser can name the laser in a list.
bool can_be_listed(const std::string& name);

bool contains(const std::vector<std::string>& names, const std::string& name);

/// Quotes names and joins them with commas, for a message: "a", "b".
std::string quoted_list(const std::vector<std::string>& names);

}  // namespace psi_slam
