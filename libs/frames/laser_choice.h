// SPDX-License-Identifier: BSD-3-Clause
// Which lasers of a log the user wants, and how they are mounted where he says so.
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

/// What an option such as `log.laser` asks for: the format's usual laser, one by name, several by names with
/// commas between them, or "all". The first of several is the one that opens frames.
struct LaserChoice {
  bool all = false;
  std::vector<std::string> names;  ///< empty: all, or the usual one

  bool several() const { return all || names.size() > 1; }
};

/// Throws UserError, naming the option, when a name is empty or comes twice.
LaserChoice laser_choice(std::string_view option, std::string_view value);

/// Whether frames of a log of this format may hold scans of several lasers: topics count for bags alone,
/// where they stand over `laser`. Throws UserError when a mount is stated that is for one laser, and for
/// choices that laser_choice() refuses.
bool reads_several_lasers(const LogOptions& options, LogFormat format);

/// The lasers that are read of a log that names each scan's laser, numbered as in LaserScan::laser: those
/// that the user lists in his order, all by their first scans, or the first one to come.
class ChosenLasers {
 public:
  explicit ChosenLasers(LaserChoice choice) : choice_(std::move(choice)) {}

  /// The number of a laser that is read; none for the others. A laser that comes for the first time may be
  /// taken in.
  std::optional<std::size_t> number_of(const std::string& name);

  /// Those that are read, as far as they have come or were listed.
  std::vector<std::string> names() const;

 private:
  LaserChoice choice_;
  std::map<std::string, std::size_t> numbers_;
};

/// The mount of one laser as the user states it.
struct StatedMount {
  std::string name;
  mrpt::math::TPose2D robot_T_laser;
  bool mirrored = false;
};

/// `LogOptions::laser_mounts`, taken apart. Throws UserError saying what was expected.
std::vector<StatedMount> stated_mounts(const LogOptions& options);

/// The options for one laser, which goes by any of these names: with its stated mount, if it has one.
LogOptions options_of_laser(const LogOptions& options, const std::vector<std::string>& names);

/// Names for a sentence: "a", "b".
std::string quoted_list(const std::vector<std::string>& names);

}  // namespace psi_slam
