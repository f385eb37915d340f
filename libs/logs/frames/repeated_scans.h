// SPDX-License-Identifier: BSD-3-Clause
// Finds scans that are no new measurement: a lidar that stalls, or its driver, gives the readings of an
// earlier scan again with a new time stamp. The readings then repeat to the last bit although the robot
// moved.
//
// A simulator without noise repeats readings truthfully, which other explanations of a repeat cover: the
// robot stands, it is back where it measured these readings as far as odometry can tell, or the walls look
// the same from both poses, as in a bare corridor. The laser must show that its readings change, if not
// before a repeat, then soon after it.
#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <string>

#include "psi_slam/frame.h"

namespace psi_slam {

class RepeatedScans {
 public:
  /// kPerhaps: the frame repeats an earlier one if its laser shows later that its readings change.
  enum class Judgement { kNew, kPerhaps, kRepeats };

  /// Takes the next frame of a reader, whose companions are empty. Judges whether its readings are those of
  /// an earlier scan of the laser although odometry, or else the gyroscope, shows that the robot is
  /// elsewhere.
  Judgement judge(const Frame& frame);

  /// Returns whether judge() decides that a frame repeats an earlier one, and counts it.
  bool repeats(const Frame& frame);

  /// Returns whether the readings of a laser have changed often enough.
  bool shows_change(std::size_t laser) const;

  /// Counts a frame that is left out.
  void count(const Frame& frame);

  /// States how many frames were counted, and when: one sentence without full stop; empty for none.
  std::string sentence() const;

 private:
  /// Readings that a laser gave, with the newest pose at which they can have been measured.
  struct Seen {
    Frame frame;
    double path_m = 0;  ///< path_m_ at that pose
    double turned_rad = 0;
  };

  void travel(const Frame& frame);
  bool is_elsewhere(const Seen& seen, const Frame& frame) const;

  std::map<std::size_t, std::deque<Seen>> seen_;  ///< by the laser, in the order in which they first came
  Frame last_;                                    ///< the frame before, without readings
  bool has_last_ = false;
  double path_m_ = 0;      ///< path by odometry so far
  double turned_rad_ = 0;  ///< sum of the absolute turns so far
  TimeUs begin_us_ = 0;    ///< time of the first frame
  std::size_t count_ = 0;
  TimeUs first_us_ = 0;  ///< time of the first repeat
  TimeUs last_us_ = 0;   ///< time of the newest repeat
};

}  // namespace psi_slam
