// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationIMU.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/poses/CPose3D.h>

#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "logs/frames/gyroscope_headings.h"
#include "logs/frames/height_slice.h"
#include "logs/frames/laser_choice.h"
#include "logs/frames/odometry_interpolator.h"
#include "psi_slam/frame.h"
#include "psi_slam/frame_source.h"
#include "psi_slam/log_options.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

/// Converts the 2D range scans of one sensor from MRPT's form to a LaserScan. Projects the sensor's pose to
/// the floor. Mirrors the bearings of a laser that is mounted upside down.
class RawlogLaser {
 public:
  explicit RawlogLaser(const LogOptions& options) : options_(options) {}

  /// Converts a scan. Throws UserError that starts with `place` if the scan has no rays or its laser is
  /// tilted by more than 15 degrees.
  LaserScan scan(const mrpt::obs::CObservation2DRangeScan& observation, const std::string& place);

 private:
  std::vector<float> bearings_rad(std::size_t beams, double aperture_rad, bool clockwise) const;

  LogOptions options_;
  std::tuple<std::size_t, double, bool> geometry_;  // beams, aperture and clockwise direction of bearings_
  BeamBearings bearings_;
};

/// Error for a laser whose mount the user has to state.
class MissingMount : public UserError {
 public:
  using UserError::UserError;
};

/// Returns whether psi-slam maps observations of this class: 2D range scans, or with `slices` slices of
/// clouds, see is_cloud().
bool is_scan(const mrpt::obs::CObservation& observation, bool slices);

/// Selects the lasers to read among MRPT's observations, by their sensor labels.
class RawlogLasers {
 public:
  explicit RawlogLasers(const LogOptions& options)
      : options_(options), slice_(height_slice(options)), chosen_(laser_choice("log.laser", options.laser)) {}

  /// Converts a scan or, if `log.slice_z_m` is set, slices a cloud. Returns nothing for other observations,
  /// and if the laser is not read. Throws UserError that starts with `place` for the errors of
  /// RawlogLaser::scan() and for a cloud whose points cannot be read. Throws MissingMount if two lasers
  /// without a mount in the options have the same pose on the robot, which means that the poses were never
  /// set.
  std::optional<LaserScan> scan(const mrpt::obs::CObservation& observation, const std::string& place);

  /// Labels of the lasers by their numbers: those that the user lists, otherwise those that have appeared.
  std::vector<std::string> labels() const { return chosen_.names(); }

 private:
  struct Laser {
    std::string label;
    LogOptions options;
    RawlogLaser reader;
    mrpt::poses::CPose3D robot_T_sensor;  // sensor pose in the laser's first scan
    bool is_stated = false;               // whether the user states the laser's mount
  };

  Laser& laser(std::size_t number, const mrpt::obs::CObservation& first, const std::string& place);

  LogOptions options_;
  std::optional<HeightSlice> slice_;
  ChosenLasers chosen_;
  std::map<std::size_t, Laser> lasers_;
};

/// Returns whether an observation of an IMU holds a rate of turn.
bool has_rate(const mrpt::obs::CObservationIMU& imu);

/// Makes frames from MRPT's actions and observations. Odometry is either the sum of the actions, or
/// interpolated between the odometry observations of the first label. In the second case, a scan waits for
/// the next odometry. Odometry that is not finite or beyond 10,000 km is skipped.
class ObservationFrames {
 public:
  enum class Odometry { kUndecided, kActions, kObservations, kNone };

  /// Prepares to read the lasers that `options` choose. If `odometry` is kUndecided, uses the kind of
  /// odometry that comes first, or none if OdometryInterpolator::kMaxWaiting scans come before any. If
  /// `options` ask for no odometry, kNone applies. Only with kNone, `gyroscope`, a sensor label, selects the
  /// observations of IMUs that give the headings of the frames. `most_waiting` scans may wait for odometry.
  explicit ObservationFrames(const LogOptions& options, Odometry odometry = Odometry::kUndecided,
                             std::optional<std::string> gyroscope = std::nullopt,
                             std::size_t most_waiting = OdometryInterpolator::kMaxWaiting);

  /// Takes the movement of the robot, if there is one. `place` says where the action is in the log.
  void take(const mrpt::obs::CActionCollection& action, const std::string& place);

  /// Takes a scan, odometry or a rate of the gyroscope, and ignores other observations. Throws UserError,
  /// starting with `place`, if the observation has no time stamp or a scan is invalid (see RawlogLasers).
  void take(const mrpt::obs::CObservation& observation, const std::string& place);

  /// Returns the next complete frame, with the scan of one laser, or nothing if there is none yet. Its index
  /// is the number of the scan among the scans taken, counted from 0.
  std::optional<Frame> next();

  /// See RawlogLasers::labels().
  std::vector<std::string> labels() const { return lasers_.labels(); }

  /// Number of scans taken. Scans of lasers that are not read do not count.
  std::size_t scans() const { return scans_; }

  /// Odometry that was skipped because it is not finite.
  const SkippedLines& skipped() const { return skipped_; }

  /// Lets next() return the scans that still wait for odometry.
  void end_of_log();

 private:
  void take_scan(const mrpt::obs::CObservation& observation, const std::string& place);
  void take_odometry(const mrpt::obs::CObservationOdometry& observation, const std::string& place);
  void take_imu(const mrpt::obs::CObservationIMU& observation);
  bool uses_gyroscope() const { return odometry_ == Odometry::kNone && gyroscope_; }
  void skip(const std::string& place);
  void decide_for_none();

  RawlogLasers lasers_;
  bool slices_clouds_;
  Odometry odometry_;
  std::optional<std::string> odometry_label_;
  std::optional<std::string> gyroscope_;
  mrpt::math::TPose2D odom_T_robot_{0, 0, 0};  ///< the sum of the actions
  OdometryInterpolator waiting_;
  GyroscopeHeadings headings_;  ///< instead of waiting_ if a gyroscope is used
  std::deque<Frame> ready_;
  std::size_t scans_ = 0;
  bool is_motion_unknown_ = false;  ///< whether an action since the last scan was skipped
  SkippedLines skipped_;
};

}  // namespace psi_slam
