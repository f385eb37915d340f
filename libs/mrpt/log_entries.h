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
  /// The next entry, or none at the end. Throws UserError if the log is damaged.
  virtual std::optional<LogEntry> next() = 0;
  /// Share of the log read so far, in [0, 1].
  virtual double progress() const = 0;
  /// Whether the entries are made from frames. Then the log options are applied already and must not be
  /// applied again.
  virtual bool are_made() const = 0;
};

/// Opens a log. Entries of a rawlog are unchanged, except that scans of other lasers than log.laser, or the
/// first laser, are left out. For other formats, and for several lasers, there is an entry per frame: the
/// movement and the scans of all lasers, the main laser first, since MRPT's deciders take the first scan.
/// Throws UserError if the log cannot be opened; next() throws it if no laser has the label of log.laser.
std::unique_ptr<LogEntries> open_log_entries(const std::filesystem::path& log, const LogOptions& options);

}  // namespace psi_slam
