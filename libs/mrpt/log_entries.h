// SPDX-License-Identifier: BSD-3-Clause
// Reads a log entry by entry, in the form that MRPT's graph-slam engine takes.
#pragma once

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "psi_slam/log_options.h"

namespace psi_slam {

/// An action with a sensory frame, or a single observation.
struct LogEntry {
  mrpt::obs::CActionCollection::Ptr action;
  mrpt::obs::CSensoryFrame::Ptr observations;
  mrpt::obs::CObservation::Ptr observation;
};

class LogEntries {
 public:
  virtual ~LogEntries() = default;
  /// Returns the next entry, or nothing at the end of the log. Throws UserError if the log is damaged.
  virtual std::optional<LogEntry> next() = 0;
  /// Share of the log read so far, in [0, 1].
  virtual double progress() const = 0;
  /// Whether the entries are made from frames. The log options then have been applied to the frames already,
  /// and must not be applied again.
  virtual bool are_made() const = 0;
  /// Whether the robot's movements in the actions are measured. Entries that are made from frames without
  /// odometry contain zero movements, because MRPT needs an action with each scan.
  virtual bool have_odometry() const = 0;
};

/// Opens a log. If one laser of a rawlog is read, entries are unchanged, but scans of other lasers are left
/// out, and observations that are neither scans nor odometry or those of gyroscopes. That laser is log.laser,
/// or the first one if log.laser is empty. In all other cases each frame becomes an entry with the movement
/// and the scans of all lasers that are read. The main laser comes first, because MRPT's deciders take the
/// first scan. Throws UserError if the log cannot be opened; next() throws it if no laser has the label of
/// log.laser.
std::unique_ptr<LogEntries> open_log_entries(const std::filesystem::path& log, const LogOptions& options);

}  // namespace psi_slam
