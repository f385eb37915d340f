// SPDX-License-Identifier: BSD-3-Clause
// Facts about a log, collected in one pass without judgement.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <string>
#include <vector>

#include "logs/frames/log_reader.h"
#include "psi_slam/frame.h"
#include "psi_slam/time_stamp.h"

namespace psi_slam {

/// Times of consecutive scans, in the order of the log.
struct TimeFacts {
  TimeUs first_us = 0;
  TimeUs last_us = 0;
  double duration_s = 0;       ///< time from the earliest to the latest scan
  double median_period_s = 0;  ///< median time between consecutive scans
  std::size_t gaps = 0;        ///< periods above both 1 s and ten times the median
  double largest_gap_s = 0;
  std::size_t backward_steps = 0;  ///< scans that are earlier than the previous one
  double largest_backward_step_s = 0;
  std::size_t repeated_stamps = 0;  ///< scans with the time of the previous one
  std::size_t repeated_scans = 0;   ///< scans that repeat the time and all ranges of the previous one
};

struct OdometryFacts {
  double path_length_m = 0;
  double turned_rad = 0;  ///< sum of the absolute turns between consecutive scans
  double largest_step_m = 0;
  double largest_turn_rad = 0;  ///< largest turn between consecutive scans
};

struct RangeFacts {
  std::size_t readings = 0;
  std::size_t returns = 0;
  /// Readings that a reader makes no number: zero, negative, below the minimum range that the log states, and
  /// those of masked beams.
  std::size_t invalid = 0;
  std::size_t empty_scans = 0;  ///< scans without any return
  float max_range_m = 0;        ///< readings of at least this range are no returns
  float median_return_m = 0;
  float largest_reading_m = 0;  ///< largest finite reading, including codes for "no return"; rounded to 1 cm

  double return_share() const {
    return readings == 0 ? 0 : static_cast<double>(returns) / static_cast<double>(readings);
  }
};

struct LogFacts {
  std::string broken_off;  ///< error after the last readable scan; empty for a complete log
  std::string format;      ///< "CARMEN", "MRPT rawlog", ...
  LogContents contents;    ///< messages, lasers and skipped lines that the reader counted
  std::size_t scans = 0;
  std::size_t beams = 0;  ///< number of beams of the first scan
  double first_bearing_rad = 0;
  double last_bearing_rad = 0;
  std::size_t scans_without_odometry = 0;
  std::size_t scans_of_other_shape = 0;  ///< scans whose number of beams differs from the first
  mrpt::math::TPose2D robot_T_laser;
  TimeFacts time;
  OdometryFacts odometry;
  RangeFacts ranges;
};

/// Returns whether a scan of the frame has a finite range.
bool has_return(const Frame& frame);

/// Returns why a log without any return cannot be mapped. `log` names it.
std::string no_returns_text(const std::string& log, std::size_t scans);

/// Time and odometry of a frame. Scans are not kept.
struct FrameMark {
  TimeUs time_us = 0;
  mrpt::math::TPose2D odom_T_robot;
};

/// Returns the times from each frame to the next, seconds. They are negative where the clock steps back.
std::vector<double> periods_between(const std::vector<FrameMark>& marks);

class LogFactsCollector {
 public:
  /// Adds a frame whose ranges were read without limits. Readings from `min_range_m` on and below
  /// `max_range_m` count as returns.
  void add(const Frame& frame, float max_range_m, float min_range_m = 0);

  const std::vector<FrameMark>& marks() const { return marks_; }

  /// Returns the facts of all frames so far. The caller sets the members that come from the reader:
  /// `broken_off`, `format` and `contents`.
  LogFacts facts() const;

 private:
  LogFacts facts_;
  std::vector<FrameMark> marks_;
  std::vector<float> last_ranges_m_;
  std::vector<std::size_t> readings_by_cm_;
};

}  // namespace psi_slam
