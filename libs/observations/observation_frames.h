// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>

#include <cstddef>
#include <deque>
#include <optional>
#include <string>

#include "frames/odometry_interpolator.h"
#include "observations/rawlog_lasers.h"
#include "psi_slam/frame.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

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
  void begin_with_actions();

  RawlogLasers lasers_;
  Odometry odometry_;
  std::optional<std::string> odometry_label_;
  mrpt::math::TPose2D odom_T_robot_{0, 0, 0};  ///< the sum of the actions
  OdometryInterpolator waiting_;
  std::deque<Frame> ready_;
  std::size_t scans_ = 0;
};

}  // namespace psi_slam
