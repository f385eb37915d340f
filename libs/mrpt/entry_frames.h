// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/obs/CSensoryFrame.h>

#include <string>

#include "logs/frames/max_range_study.h"
#include "logs/frames/scan_synchronizer.h"
#include "logs/observations/observation_frames.h"

namespace psi_slam {

/// Makes frames from the entries that MRPT's programs pass on: an action with a sensory frame, or a single
/// observation. A frame holds the scan of one laser, or the scans of several lasers combined by
/// ScanSynchronizer. Without log.max_range_m, codes for "no return" are learned from the scans taken so far,
/// see MaxRangeStudy.
class EntryFrames {
 public:
  /// Prepares to read the lasers that `options` choose. Error messages start with `speaker`. Throws UserError
  /// if an option is invalid, or if `options` ask for corrections of odometry or time stamps.
  explicit EntryFrames(const LogOptions& options, std::string speaker = "entries");

  /// Takes one entry; each argument may be null. Throws UserError if a scan has no time stamp or no rays, or
  /// its laser is tilted.
  void take(const mrpt::obs::CActionCollection::Ptr& action,
            const mrpt::obs::CSensoryFrame::Ptr& observations,
            const mrpt::obs::CObservation::Ptr& observation);

  /// Returns the next complete frame, or nothing if it needs further entries.
  std::optional<Frame> next();

  /// Number of scans in the entries taken so far. Scans of lasers that are not read do not count.
  std::size_t scans() const { return scans_.scans(); }

  /// Index, among all scans taken, of the scan that began the frame last returned by next(). Counts from 0
  /// and increases from frame to frame.
  std::size_t opened_by() const { return opened_by_; }

  /// Odometry that was skipped because it is not finite.
  const SkippedLines& skipped() const { return scans_.skipped(); }

  /// Lets next() return the scans that still wait for odometry or for scans of other lasers.
  void end_of_log();

 private:
  void take(const mrpt::obs::CObservation& observation);
  std::optional<Frame> next_scan();

  std::string speaker_;
  ObservationFrames scans_;
  bool several_lasers_;
  bool learns_max_ranges_;
  MaxRangeStudy study_;
  MaxRanges max_ranges_;
  ScanSynchronizer synchronizer_;
  bool ended_ = false;
  std::size_t actions_ = 0;
  std::size_t observations_ = 0;
  std::size_t frames_ = 0;
  std::size_t opened_by_ = 0;
};

}  // namespace psi_slam
