// SPDX-License-Identifier: BSD-3-Clause
// Finds and masks the robot's own body in its scans: a mast, a cable or a part of the shell that a laser
// sees.
//
// Readings of the body keep their bearing and range while the robot turns. Readings of the surroundings do
// not. The finder therefore compares key scans. From one key scan to the next, the robot turned by
// kKeyTurn_rad (by odometry or else by the gyroscope), and half of the readings beyond kFar_m changed. If the
// heading is unknown, three quarters of these readings changed.
//
// A beam sees the body at range r if kLeastSeen key scans show r (kLeastSeenWithoutHeading if the heading is
// unknown), and if these are at least kLeastShare of all key scans in which the beam measured less than 2 r.
// The second condition excludes walls. If a robot passes walls at a constant distance r, a beam measures
// r / cos(turn) while the robot turns, so it measures all ranges from r to 2 r at each corner. Ranges beyond
// 2 r do not count, because some beams see past the body at times.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/degrees.h"
#include "psi_slam/frame_source.h"

namespace psi_slam {

/// Neighbouring beams of one laser that see the robot itself. Bearings are in the laser's frame.
struct BodySector {
  std::size_t laser = 0;  ///< number of the laser, see LaserScan::laser
  mrpt::math::TPose2D robot_T_laser;
  std::size_t beams = 0;
  double from_rad = 0;  ///< bearing of the first beam
  double to_rad = 0;    ///< bearing of the last beam
  double width_rad = 0;
  double nearest_m = 0;   ///< minimum range of the body in these beams
  double farthest_m = 0;  ///< maximum range of the body in these beams
};

/// Sectors as text: "8 beams from 40.0 to 47.0 degrees at 0.35 m, 1 beam at -20.0 degrees at 0.50 m". Names
/// at most five sectors and counts the rest.
std::string text_of(const std::vector<BodySector>& sectors);

/// Assigns bearings to the beams of a laser's first scan, so that scans of other numbers of beams compare.
class BearingBins {
 public:
  explicit BearingBins(const std::vector<float>& bearings_rad);

  std::size_t size() const { return size_; }
  double step_rad() const { return step_rad_; }
  double bearing_rad(std::size_t bin) const { return first_rad_ + step_rad_ * static_cast<double>(bin); }

  /// Returns the bin nearest to a bearing; empty if the bearing is outside the field of view of the first
  /// scan.
  std::optional<std::size_t> bin_of(float bearing_rad) const;

  /// Returns the bins beside a bin and the bin itself. In a full circle, the first and the last bin are side
  /// by side.
  std::vector<std::size_t> around(std::size_t bin) const;

 private:
  double first_rad_;
  double step_rad_;
  std::size_t size_;
  bool is_full_circle_;
};

/// Bearings and ranges at which the lasers of a robot see the robot itself.
class OwnBodyMask {
 public:
  /// Adds a laser. `body_ranges_m` has the range of the body for each bin, metres; 0 for beams that do not
  /// see it.
  void add_laser(std::size_t laser, const mrpt::math::TPose2D& robot_T_laser, const BearingBins& bins,
                 const std::vector<double>& body_ranges_m);

  /// Replaces readings of the body by NaN: readings near the range of the body, of beams that see it and of
  /// their neighbours. Keeps readings that pass the body.
  void apply(LaserScan& scan) const;

  /// All sectors, ordered by laser and beam; empty if no laser sees the robot.
  const std::vector<BodySector>& sectors() const { return sectors_; }

 private:
  /// Ranges from `from_m` to `to_m`; empty by default.
  struct Band {
    float from_m = 1;
    float to_m = 0;
  };

  struct Laser {
    BearingBins bins;
    std::vector<Band> bands;  ///< readings that are masked, for each bin
  };

  std::map<std::size_t, Laser> lasers_;
  std::vector<BodySector> sectors_;
};

/// Collects key scans and finds the beams that see the robot itself.
class OwnBodyFinder {
 public:
  static constexpr double kKeyTurn_rad = radians_from_degrees(20);
  static constexpr double kFar_m = 2.0;
  static constexpr double kReach_m = 1.0;  ///< the body is at most this far from the laser
  static constexpr std::size_t kMostFrames = 10'000;
  static constexpr std::size_t kMostKeyScans = 60;
  static constexpr std::size_t kLeastSeen = 15;
  static constexpr std::size_t kLeastSeenWithoutHeading = 40;
  static constexpr double kLeastShare = 0.8;
  static constexpr double kLeastTravel_m = 2.0;  ///< least path along the key scans, where there is odometry

  /// Takes the scans of all lasers in a frame. Call it in the order of the log.
  void add(const Frame& frame);

  /// Returns whether further frames would change nothing: kMostFrames frames were added, or every laser so
  /// far has kMostKeyScans key scans.
  bool settled() const;

  OwnBodyMask mask() const;

 private:
  /// What is known of the robot's motion until a scan.
  struct Motion {
    bool has_odometry = false;
    mrpt::math::TPose2D odom_T_robot;
    std::optional<double> imu_heading_rad;
  };

  struct Laser {
    explicit Laser(const LaserScan& scan);

    BearingBins bins;
    mrpt::math::TPose2D robot_T_laser;
    Motion key;                        ///< motion until the last key scan
    std::vector<float> key_ranges_m;   ///< ranges of the last key scan, by bin
    std::vector<std::uint8_t> counts;  ///< key scans by bin and range, see kCells
    std::size_t key_scans = 0;
    double travelled_m = 0;
    bool knows_headings = true;  ///< whether the turn between all key scans is known
    bool knows_travel = true;    ///< whether the path between all key scans is known
  };

  static std::optional<double> turn_rad(const Motion& from, const Motion& to);
  static bool is_key_scan(const Laser& laser, const Motion& motion, const std::vector<float>& ranges_m);
  static void take_key_scan(Laser& laser, const Motion& motion, std::vector<float> ranges_m);
  void add(const LaserScan& scan, const Motion& motion);

  std::size_t frames_ = 0;
  std::map<std::size_t, Laser> lasers_;
};

/// Reads a log until the finder has settled. With `most_s`, the log is a stream, which is looked over for so
/// many seconds, see LookOver. Stops without an error where the log is damaged.
OwnBodyMask find_own_body(FrameSource& log, std::optional<double> most_s = std::nullopt);

}  // namespace psi_slam
