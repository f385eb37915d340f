// SPDX-License-Identifier: BSD-3-Clause
// Finds the code that a laser writes for "no return", by its readings.
//
// A log may state a maximum range of 81.90 m, or none, while the laser writes 81.83 m if a beam hits nothing.
// Such a code is one value at the top of all readings, whatever the robot sees. Distances to walls change as
// the robot moves, and vary by the noise of the laser.
//
// The study therefore compares views. A view is a scan in which most readings below the largest one changed
// since the last view by more than 3 %. A robot that stands still in front of a wall thus adds no views. The
// study counts readings of all views, rounded to 1 cm. It takes all readings from 3 % below the largest one
// that kLeastViews views show. If more than half of them have one value, this value is a code. The study then
// repeats with the readings below this code, because many lasers write several codes. Readings from the
// smallest code on are no returns.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "psi_slam/frame_source.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// Maximum range of a laser, as its readings show.
struct MaxRange {
  mrpt::math::TPose2D robot_T_laser;
  double max_range_m = kUnstatedMaxRange_m;  ///< readings of at least this range are no returns
  double stated_max_range_m = 0;             ///< as the log states; 0 if it states none
  double code_m = 0;                         ///< smallest code for "no return"; 0: none
  bool is_surprise = false;  ///< whether the code is below the stated maximum, or else below 50 m
};

/// Maximum range of each laser, by its number (LaserScan::laser).
using MaxRanges = std::map<std::size_t, MaxRange>;

/// Collects the readings of all lasers of a log.
class MaxRangeStudy {
 public:
  static constexpr std::size_t kLeastViews = 15;

  /// Takes a scan as a LogReader yields it: readings beyond the stated maximum are infinite, and
  /// LaserScan::max_range_m is 0 if the log states no maximum. Call it in the order of the log.
  void add(const LaserScan& scan);

  /// Adds a scan, and brings `max_ranges`, those of this study, up to date.
  void learn(const LaserScan& scan, MaxRanges& max_ranges);

  /// Number of views of all lasers. The maximum ranges change only if this number does.
  std::size_t views() const { return views_; }

  /// Maximum ranges of all lasers so far: the smallest code, otherwise as stated, otherwise 50 m.
  MaxRanges max_ranges() const;

 private:
  struct Cell {
    std::size_t readings = 0;
    std::size_t views = 0;  // views with such readings
    std::size_t last_view = 0;
  };

  struct Laser {
    mrpt::math::TPose2D robot_T_laser;
    double stated_max_range_m = 0;
    std::vector<float> view_m;  // ranges of the last view
    std::size_t views = 0;
    std::vector<Cell> cells;  // by range in centimetres
  };

  static std::optional<std::size_t> code_before(const std::vector<Cell>& cells, std::size_t end);
  static std::optional<std::size_t> smallest_code_before(const std::vector<Cell>& cells, std::size_t end);
  static MaxRange max_range_of(const Laser& laser);

  std::map<std::size_t, Laser> lasers_;
  std::size_t views_ = 0;
};

/// Returns the maximum ranges by a study of a whole log. Ends without an error where the log is damaged.
MaxRanges study_max_ranges(FrameSource& log);

/// Applies the maximum range of its laser to a scan. Leaves a scan unchanged if its log states a maximum and
/// the laser has no code below it.
void apply_max_range(const MaxRanges& max_ranges, LaserScan& scan);

/// Says which code a laser writes and what follows from it: a sentence without full stop that names the
/// option to change it. The mount tells the laser from others. Requires a code.
std::string sentence_of(const MaxRange& max_range);

}  // namespace psi_slam
