// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/poses/CPose3D.h>

#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "frames/laser_choice.h"
#include "frames/odometry_interpolator.h"
#include "psi_slam/frame.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// Turns MRPT's 2D range scans of one sensor into ours. The sensor's pose is projected to the floor. A laser
/// that is mounted upside down gets mirrored bearings.
class RawlogLaser {
 public:
  explicit RawlogLaser(const LogOptions& options) : options_(options) {}

  /// Throws UserError that starts with `place` if the scan has no rays or its laser is tilted by more than 15
  /// degrees.
  LaserScan scan(const mrpt::obs::CObservation2DRangeScan& observation, const std::string& place);

 private:
  std::vector<float> bearings_rad(std::size_t beams, double aperture_rad, bool clockwise) const;

  LogOptions options_;
  std::tuple<std::size_t, double, bool> geometry_;  // of bearings_: beams, aperture, clockwise
  BeamBearings bearings_;
};

/// Selects the lasers to read among MRPT's observations, by their sensor labels.
class RawlogLasers {
 public:
  explicit RawlogLasers(const LogOptions& options)
      : options_(options), chosen_(laser_choice("log.laser", options.laser)) {}

  /// Returns nothing if the laser is not read. Throws UserError that starts with `place` if RawlogLaser does,
  /// and if two lasers have the same pose: their poses were then never set.
  std::optional<LaserScan> scan(const mrpt::obs::CObservation2DRangeScan& observation,
                                const std::string& place);

 private:
  struct Laser {
    std::string label;
    RawlogLaser reader;
    mrpt::poses::CPose3D robot_T_sensor;  // of its first scan
    bool is_stated = false;               // the user states its mount
  };

  Laser& laser(std::size_t number, const mrpt::obs::CObservation2DRangeScan& first, const std::string& place);

  LogOptions options_;
  ChosenLasers chosen_;
  std::map<std::size_t, Laser> lasers_;
};

/// Makes frames from MRPT's actions and observations. Odometry is either the sum of the actions or
/// interpolated between odometry observations of the first label; then a scan waits for the next odometry.
class ObservationFrames {
 public:
  enum class Odometry { kUndecided, kActions, kObservations };

  /// If undecided, the kind of odometry that comes first is used.
  explicit ObservationFrames(const LogOptions& options, Odometry odometry = Odometry::kUndecided);

  void take(const mrpt::obs::CActionCollection& action);

  /// Throws UserError, starting with `place`, if the observation has no time stamp, a scan is invalid (see
  /// RawlogLasers), or many scans came without odometry.
  void take(const mrpt::obs::CObservation& observation, const std::string& place);

  /// The next complete frame, with the scan of one laser. Its index is the number of the scan among those
  /// read.
  std::optional<Frame> next();

  /// Number of scans taken, without those of lasers that are not read.
  std::size_t scans() const { return scans_; }

  /// Lets next() return the scans that still wait. Throws UserError, starting with `place`, if there are such
  /// scans and no odometry came.
  void end_of_log(const std::string& place);

 private:
  void take_scan(const mrpt::obs::CObservation2DRangeScan& observation, const std::string& place);
  void take_odometry(const mrpt::obs::CObservationOdometry& observation, const std::string& place);

  RawlogLasers lasers_;
  Odometry odometry_;
  std::optional<std::string> odometry_label_;
  mrpt::math::TPose2D odom_T_robot_{0, 0, 0};  ///< the sum of the actions
  OdometryInterpolator waiting_;
  std::deque<Frame> ready_;
  std::size_t scans_ = 0;
};

}  // namespace psi_slam
