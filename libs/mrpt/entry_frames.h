// SPDX-License-Identifier: BSD-3-Clause
// Makes frames of what MRPT's programs hand on one by one: either an action with a sensory frame, or a single
// observation. Scans are those of one laser, or of several that are put together as ScanSynchronizer says.
// The kind of odometry that comes first decides; scans whose odometry comes in observations wait for the
// odometry behind them, as when a log is read.
#pragma once

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <deque>
#include <optional>
#include <string>

#include "frames/odometry_interpolator.h"
#include "frames/scan_synchronizer.h"
#include "observations/rawlog_lasers.h"
#include "psi_slam/frame.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

class EntryFrames {
 public:
  /// All sentences of errors begin with `speaker`. Throws UserError when an option makes no sense.
  explicit EntryFrames(const LogOptions& options, std::string speaker = {});

  /// Any of the three may be null. Throws UserError when a scan has no time stamp or no rays, its laser is
  /// tilted, or no odometry comes.
  void take(const mrpt::obs::CActionCollection::Ptr& action,
            const mrpt::obs::CSensoryFrame::Ptr& observations,
            const mrpt::obs::CObservation::Ptr& observation);

  /// The next frame that is complete.
  std::optional<Frame> next();

  /// How many scans were taken.
  std::size_t scans() const { return scans_; }

  /// Which of them, counted from 0, opened the frame that next() gave last; they come in this order, and of
  /// one laser each opens a frame.
  std::size_t opened_by() const { return opened_by_; }

  /// Scans that still wait need wait no longer. Throws UserError when there are some and odometry never came.
  void end_of_log();

 private:
  enum class Odometry { kUndecided, kActions, kObservations };
  void take(const mrpt::obs::CObservation& observation);
  void take_scan(const mrpt::obs::CObservation2DRangeScan& observation);
  void take_odometry(const mrpt::obs::CObservationOdometry& observation);
  std::optional<Frame> next_scan();
  void begin_with_actions();
  static TimeUs stamp_of(const mrpt::obs::CObservation& observation, const std::string& what);
  [[noreturn]] void throw_no_odometry(std::size_t scans) const;

  std::string speaker_;
  RawlogLasers lasers_;
  bool several_lasers_;
  std::optional<std::string> odometry_label_;
  Odometry odometry_ = Odometry::kUndecided;
  mrpt::math::TPose2D odom_T_robot_{0, 0, 0};  ///< the sum of the actions
  OdometryInterpolator waiting_;
  std::deque<Frame> ready_;
  ScanSynchronizer synchronizer_;  ///< of several lasers
  bool ended_ = false;
  std::size_t scans_ = 0;
  std::size_t frames_ = 0;
  std::size_t opened_by_ = 0;
};

}  // namespace psi_slam
